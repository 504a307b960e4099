// What light transport asks of geometry: nearest hit, and whether anything is in the way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "field/base/id.h"
#include "field/math/box3.h"
#include "field/math/ray.h"
#include "field/math/vec3.h"
#include "field/trace/kernels/field_around.h"

namespace marrow {

struct SurfaceHit {
  double t = 0;     ///< along the ray, scene units
  Vec3d position;   ///< on the surface
  UnitVec3 normal;  ///< outward: for a field -gradient/|gradient|; geometric and shading normal are one
  Vec3d outside;    ///< a point beside `position`, certified to lie outside: reflected rays start here, at t = 0
  ObjectId object;
  MaterialId material;
  FieldAround around;  ///< for rays from `outside`

  /// The hit must outlive the ray.
  Ray leaving(const UnitVec3& direction, double t_max = std::numeric_limits<double>::infinity()) const {
    return {outside, direction, 0, t_max, &around};
  }
};

/// What it took to answer a ray. A function of the ray alone, whatever the order of traversal.
struct RayRecord {
  /// Of fields, in all cells that the ray entered before its hit; those that tell on which side it begins not counted.
  std::uint32_t evaluations = 0;
  /// It is proved that no surface before the hit (or anywhere) was skipped, and doubles tell the place of the hit as
  /// finely as surfaces of solids are traced.
  bool certified = true;
};

/// Immutable and safe to call from many threads.
class Surfaces {
 public:
  virtual ~Surfaces() = default;
  /// The first hit with ray.t_min <= t <= ray.t_max.
  virtual std::optional<SurfaceHit> first_hit(const Ray& ray) const {
    RayRecord unused;
    return first_hit(ray, unused);
  }
  /// The same hit, to the same bits, and what it took.
  virtual std::optional<SurfaceHit> first_hit(const Ray&, RayRecord&) const = 0;
  /// Whether any surface lies on the ray within its interval: where it has a first hit, but for a touch of the surface
  /// that first_hit() could not decide (RayRecord::certified), or that is no deeper than sums of fields are exact
  /// (1e-10 in general trees).
  virtual bool occluded(const Ray&) const = 0;
  /// What first_hit() finds for each of the rays, to the same bits. Sooner for many rays through the same region, those
  /// of neighbouring pixels next to each other.
  virtual void first_hits(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = first_hit(rays[i]);
  }
  /// The same, and what each took, as first_hit() tells.
  virtual void first_hits(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits,
                          std::span<RayRecord> records) const {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = first_hit(rays[i], records[i]);
  }
  /// What occluded() says of each of the rays: hidden[i] becomes 1 or 0.
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const {
    for (std::size_t i = 0; i < rays.size(); ++i) hidden[i] = occluded(rays[i]) ? 1 : 0;
  }
  /// Whether rays are traced sooner together than one by one.
  virtual bool traces_packets() const { return false; }
  /// Of all finite objects; planes do not count. Empty when there are none.
  virtual Box3 bounds() const = 0;
  /// Uses what earlier rays have found for a finer division of space: later rays get the same answers, sooner. To be
  /// called a few times at most, when there are many rays to come; rays may be under way.
  virtual void refine() const {}
};

}  // namespace marrow
