// The solids of one object are one body: a surface inside another of them is none.
//
// From outside the nearest hit of all is that of the body. A ray that begins inside may come to surface that another
// solid is all around: it goes on to where it leaves that one, until nothing is around it any more.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "field/base/result.h"
#include "field/math/growing_steps.h"
#include "renderer/geometry/box_index.h"
#include "renderer/geometry/part_visit.h"
#include "renderer/geometry/solid.h"

namespace marrow {

/// Safe to use from many threads.
class UnitedSolids {
 public:
  UnitedSolids() = default;
  /// Errors: Embree could not build its hierarchy. The device and the solids must outlive it.
  static Result<UnitedSolids> make(RTCDeviceTy*, std::span<const PlacedSolid>);

  /// Whether the first hit of all solids lies inside another one of its object.
  bool is_covered(const PartHit&, const Ray&) const;
  /// Whether a ray begins inside a solid of several.
  bool begins_inside(const Ray&) const;
  /// What a ray that comes to a covered hit meets first, of all solids, one by one. `visits` grows, if there is one.
  PartHit first_hit(const Ray&, std::vector<RayVisit>* visits) const;
  /// Moves the start of further rays out of the other solids of the object, where it lies in one of them.
  void free_start(std::size_t solid, const Ray&, SurfaceHit&) const;
  /// Back along a ray that came from outside: the first of growing steps that is outside the solid's object.
  std::optional<Vec3d> start_before(std::size_t solid, const Ray&, const SurfaceHit&) const;
  bool is_outside(std::size_t solid, const Vec3d& p) const;
  /// Whether starts beside it are far enough from it to lie behind other surface: not those beside a triangle.
  bool may_be_cut_off(std::size_t solid) const { return !solids_[solid].reach.empty(); }
  /// Whether surface of another object than the solid's may pass between two places.
  bool may_part(const Vec3d& a, const Vec3d& b, ObjectId of) const;

 private:
  struct Placed {
    const Solid* solid = nullptr;
    Box3 reach;
    std::size_t body = 0;
  };
  using Body = std::vector<std::size_t>;  // solids
  struct Extent {
    ObjectId object;
    Box3 box;
  };

  explicit UnitedSolids(std::span<const PlacedSolid>);
  std::optional<std::size_t> cover_of(const PartHit&, const Ray&) const;
  PartHit nearest(std::span<const std::size_t> solids, const Ray&, std::vector<RayVisit>*) const;
  PartHit uncovered(PartHit, const Ray&, std::vector<RayVisit>*) const;
  PartHit exit_of(std::size_t cover, const Ray&, double t, std::vector<RayVisit>*) const;
  template <class Use>
  void for_each_other(std::size_t solid, const Vec3d& p, const Use&) const;
  // Of the fields of a solid and of the others of its body; what is clearly outside counts as 0.
  double largest_beside(std::size_t solid, const Vec3d& p) const;
  // The first place at which all of these are below 1 by more than the margin.
  std::optional<Vec3d> outside_along(std::size_t solid, const Vec3d& from, const Vec3d& way, const GrowingSteps&,
                                     double margin) const;

  std::vector<Placed> solids_;
  std::vector<Body> bodies_;
  std::vector<Extent> extents_;  // of bodies
  BoxIndex reaches_;             // of solids; empty boxes of those that are alone in their bodies
};

}  // namespace marrow
