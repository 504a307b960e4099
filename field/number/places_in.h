// All places of a box at once.
#pragma once

#include "field/math/box3.h"
#include "field/math/vec3.h"
#include "field/number/interval.h"

namespace marrow {

/// Precondition: the box is not empty.
inline Vec3<Interval> places_in(const Box3& b) {
  return {{b.lower.x, b.upper.x}, {b.lower.y, b.upper.y}, {b.lower.z, b.upper.z}};
}

}  // namespace marrow
