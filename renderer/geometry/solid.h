// A part of a scene whose space is divided into boxed elements: what one Embree geometry holds.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "field/base/id.h"
#include "field/math/box3.h"
#include "field/math/ray.h"
#include "field/math/ray_packet.h"
#include "field/math/side.h"
#include "field/program/field_program.h"
#include "field/trace/ray_visit.h"
#include "renderer/geometry/surfaces.h"

namespace marrow {

/// What a ray did in an element, hit or not; t along the world ray.
struct ElementLog {
  double enter = 0;                                               ///< where the ray came into the element
  double undecided = std::numeric_limits<double>::infinity();     ///< the first place that could not be decided
  const void* place = nullptr;                                    ///< of a hit in the element, for describe()
  double outside_from = std::numeric_limits<double>::infinity();  ///< CellLog's, from part to part of one solid
  /// Of a part: the ray begins inside, and elements have to be asked instead; with `any` the nearest hit.
  bool begins_inside = false;
  std::vector<RayVisit>* visits = nullptr;  ///< grows by those with evaluations, if there is one
};

/// What the rays of a packet did in a part, lane by lane.
struct PacketLog {
  std::array<double, RayPacket::size> t;          ///< of the hit; infinity: none
  std::array<ElementLog, RayPacket::size> lanes;  ///< in: as for a single ray
};

/// A part of an element, as far as it is known where in the element surface can be.
struct SolidPart {
  std::size_t element = 0;
  Box3 box{};
  const void* within = nullptr;  ///< these two are the solid's own
  int slot = 0;
};

class Solid;

/// Rays of a packet that come to one part.
struct LanesInPart {
  const Solid* solid;
  const SolidPart* part;
  LaneSet lanes;
};

/// A hit of which not all is known yet; `place` as Solid::hit() told it.
struct HitToDescribe {
  std::size_t element;
  const void* place;
  const Ray* ray;
  SurfaceHit* hit;
};

inline double longest_side(const Box3& box) { return max_component(box.size()); }

/// Immutable; safe to use from many threads. All rays and points are in world coordinates.
class Solid {
 public:
  virtual ~Solid() = default;
  virtual std::size_t element_count() const = 0;
  virtual Box3 element_box(std::size_t element) const = 0;
  /// About the extent of the body itself; a property of the scene, not of how its space is divided.
  virtual Box3 extent() const = 0;
  /// The smallest size of what rays may pass by: of all elements the least longest side, or the whole of a closed mesh,
  /// however small its triangles are.
  virtual double smallest_detail() const;
  /// Holds all that is inside; empty where nothing is, as of a mesh.
  virtual Box3 reach() const { return {}; }
  /// The exact field in world units, 1 on the surface, whatever is traced; 0 where reach() is empty.
  virtual FieldSample sample(const Vec3d&) const { return {}; }
  /// sample().value up to rounding, at a part of the cost.
  virtual double value(const Vec3d&) const { return 0; }
  /// Where value() is known to be below 0.999 or above 1.001, where that is sooner told than the value.
  virtual Side clear_side(const Vec3d&) const { return Side::Unknown; }
  /// Whether a ray leaves the surface of the solid, and so begins outside it.
  virtual bool is_left_by(const Ray&) const { return false; }
  /// t of the first hit in an element, in [ray.t_min, ray.t_max] but not depending on t_max; any hit with `any`.
  virtual std::optional<double> hit(std::size_t element, const Ray&, bool any, ElementLog&) const = 0;
  /// The elements, or what they are known to consist of by now; together they hold all surface. Whatever rays are under
  /// way meanwhile, answers stay good.
  virtual std::vector<SolidPart> parts() const;
  /// The nearest of the hits in its parts is that of an element, to the same bits.
  virtual std::optional<double> hit_in_part(const SolidPart& part, const Ray& ray, bool any, ElementLog& log) const {
    return hit(part.element, ray, any, log);
  }
  /// Whether rays are traced sooner together than one by one.
  virtual bool traces_packets() const { return false; }
  /// The same for all solids whose rays may share a packet, wherever they are placed.
  virtual const void* family() const { return this; }
  /// hit_in_part() for rays of a packet, each in one of the parts, to the same bits; `log` is of these lanes only. All
  /// solids of the parts are of this one's family.
  virtual void hits_in_parts(std::span<const LanesInPart> parts, const RayPacket& packet, bool any,
                             PacketLog& log) const {
    hits_one_by_one(parts, packet, any, log);
  }
  /// The same, sooner where there are few rays.
  static void hits_one_by_one(std::span<const LanesInPart>, const RayPacket&, bool any, PacketLog& log);
  /// Of a hit of a ray in an element, by its t: as BlendTracer::crossing_length(), in t; 0 where the search has seen to
  /// it.
  virtual double crossing_length(std::size_t, const Ray&, double) const { return 0; }
  /// Fills normal, outside and material of hits whose positions are known.
  virtual void describe(std::span<const HitToDescribe>) const = 0;
  virtual std::size_t primitive_count() const = 0;
  virtual std::size_t bytes() const = 0;
};

struct PlacedSolid {
  std::unique_ptr<Solid> solid;
  ObjectId object;
};

inline double Solid::smallest_detail() const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < element_count(); ++i) least = std::min(least, longest_side(element_box(i)));
  return least;
}

inline std::vector<SolidPart> Solid::parts() const {
  std::vector<SolidPart> parts(element_count());
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = {.element = i, .box = element_box(i)};
  return parts;
}

inline void Solid::hits_one_by_one(std::span<const LanesInPart> parts, const RayPacket& packet, bool any,
                                   PacketLog& log) {
  for (const auto& [solid, part, lanes] : parts)
    lanes.for_each([&](std::size_t lane) {
      const auto t = solid->hit_in_part(*part, packet.ray(lane), any, log.lanes[lane]);
      log.t[lane] = t.value_or(std::numeric_limits<double>::infinity());
    });
}

}  // namespace marrow
