// Solids under one Embree hierarchy, and infinite planes beside it.
#pragma once

#include <array>
#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "renderer/geometry/embree_handles.h"
#include "renderer/geometry/part_hierarchy.h"
#include "renderer/geometry/solid.h"
#include "renderer/geometry/surfaces.h"
#include "renderer/geometry/united_solids.h"

namespace marrow {

/// Both of its sides are surface; the normal of a hit looks to where the ray comes from.
struct PlacedPlane {
  Vec3d point;
  UnitVec3 normal;
  MaterialId material;
  ObjectId object;
};

/// Owns the solids, the planes, Embree's device and every hierarchy it has made, until it ends: hits that are given on
/// as FieldAround must not outlive it. Solids of one ObjectId are one body, without surface inside (united_solids.h).
/// Safe to use from many threads; refine() may be called while rays are under way, by several threads in turn, and
/// changes how soon rays are answered, never what they are answered. Once made, nothing fails: a refine() for whose
/// hierarchy there is no memory leaves things as they were.
class EmbreeSurfaces final : public Surfaces {
 public:
  /// `config` is Embree's device string, e.g. "threads=2,isa=avx2". Errors: one that Embree does not take; hierarchies
  /// that it cannot build.
  static Result<std::unique_ptr<EmbreeSurfaces>> make(std::vector<PlacedSolid>, std::vector<PlacedPlane>,
                                                      const std::string& config);

  std::optional<SurfaceHit> first_hit(const Ray&) const override;
  std::optional<SurfaceHit> first_hit(const Ray&, RayRecord&) const override;
  bool occluded(const Ray&) const override;
  void first_hits(std::span<const Ray>, std::span<std::optional<SurfaceHit>>) const override;
  void first_hits(std::span<const Ray>, std::span<std::optional<SurfaceHit>>, std::span<RayRecord>) const override;
  void occluded(std::span<const Ray>, std::span<std::uint8_t> hidden) const override;
  bool traces_packets() const override { return whole_->traces_packets(); }
  Box3 bounds() const override { return extent_; }
  void refine() const override;

  /// As they were given.
  const std::vector<PlacedSolid>& solids() const { return solids_; }
  double build_seconds = 0;  ///< for whoever makes it to set and to report

 private:
  EmbreeSurfaces(std::vector<PlacedSolid> solids, std::vector<PlacedPlane> planes)
      : solids_(std::move(solids)), planes_(std::move(planes)) {}
  // How finely space is divided: a ray meets a box with a probability that goes with its area.
  struct Division {
    std::size_t parts = 0;
    double area = 0;
    void add(const std::vector<SolidPart>&);
    bool is_like(const Division&) const;
  };
  // The plane is null when there is none on the ray; t is infinity then.
  struct PlaneHit {
    const PlacedPlane* plane = nullptr;
    double t = std::numeric_limits<double>::infinity();
  };
  PlaneHit nearest_plane(const Ray&) const;
  // Rays up to their planes.
  class BeforePlanes {
   public:
    BeforePlanes(const EmbreeSurfaces&, std::span<const Ray>);
    BeforePlanes(const BeforePlanes&) = delete;
    BeforePlanes& operator=(const BeforePlanes&) = delete;
    PlaneHit plane(std::size_t ray) const { return planes_.empty() ? PlaneHit{} : planes_[ray]; }
    std::span<const PlaneHit> planes() const { return planes_; }
    std::span<const Ray> rays;

   private:
    std::vector<PlaneHit> planes_;  // none where there are no planes
    std::vector<Ray> shorter_;
  };
  void ask_again(PartHierarchy::Hit& found, const Ray&, std::vector<RayVisit>* visits) const;
  bool hides(const PartHierarchy::Hit& any, const Ray&) const;
  PartHierarchy::Hit nearest_on(const Ray&, std::vector<RayVisit>*) const;
  bool is_resolved(const PartHierarchy::Hit&, double end, const Ray&) const;
  bool is_decided(const PartHierarchy::Hit&, double end, const Ray&) const;
  RayRecord record_of(const std::vector<RayVisit>&, const PartHierarchy::Hit&, const PlaneHit& behind,
                      const Ray&) const;
  const PartHierarchy& finest() const { return *finest_.load(std::memory_order_acquire); }
  bool is_cut_off(const Ray&, const SurfaceHit&) const;
  void uncover_start(std::size_t solid, const Ray&, SurfaceHit&) const;
  void free_start(std::size_t solid, const Ray&, SurfaceHit&) const;
  std::optional<SurfaceHit> hit_of(const PartHierarchy::Hit&, const PlaneHit& behind, const Ray&) const;
  // `behind`: the planes of all rays, or none at all.
  void describe(std::span<const PartHierarchy::Hit>, std::span<const PlaneHit> behind, std::span<const Ray>,
                std::span<std::optional<SurfaceHit>>) const;
  static void describe(const PlaneHit&, const Ray&, SurfaceHit&);
  class Describing;

  std::vector<PlacedSolid> solids_;
  std::vector<PlacedPlane> planes_;
  Box3 extent_;                                                        // of all solids
  double smallest_element_ = std::numeric_limits<double>::infinity();  // its longest side
  double smallest_body_ = std::numeric_limits<double>::infinity();  // what may be missed; see Solid::smallest_detail()
  EmbreeDevice device_;
  UnitedSolids united_;
  std::unique_ptr<const PartHierarchy> whole_;  // of whole elements
  // All stay, since rays may be under way in them.
  mutable std::vector<std::unique_ptr<const PartHierarchy>> refined_;
  mutable std::atomic<const PartHierarchy*> finest_ = nullptr;
  mutable std::mutex refining_;
  mutable Division division_;  // of the finest
};

}  // namespace marrow
