// All places of a box, or of a stretch of a ray, at once.
#pragma once

#include "field/math/box3.h"
#include "field/math/ray.h"
#include "field/math/vec3.h"
#include "field/number/interval.h"

namespace marrow {

/// Precondition: the box is not empty.
inline Vec3<Interval> places_in(const Box3& b) {
  return {{b.lower.x, b.upper.x}, {b.lower.y, b.upper.y}, {b.lower.z, b.upper.z}};
}

/// t: an interval, or a jet of one.
template <class X>
Vec3<X> places_on(const Ray& ray, const X& t) {
  const Vec3d &o = ray.origin, &d = ray.direction.vec();
  return {X(o.x) + t * X(d.x), X(o.y) + t * X(d.y), X(o.z) + t * X(d.z)};
}

}  // namespace marrow
