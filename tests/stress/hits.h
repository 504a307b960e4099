// Rays the other way and what they meet, for the judges of both tracers.
#pragma once

#include <optional>

#include "field/math/ray.h"
#include "renderer/geometry/surfaces.h"

namespace marrow::test {

/// From so far along a ray back to its origin.
inline Ray reversed(const Ray& ray, double length) { return {ray.at(length), -ray.direction, 0, length}; }

/// To the same bits.
inline bool same(const std::optional<SurfaceHit>& a, const std::optional<SurfaceHit>& b) {
  return a.has_value() == b.has_value() && (!a || (a->t == b->t && a->outside == b->outside));
}

}  // namespace marrow::test
