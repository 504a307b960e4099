// By how much boxes are padded for Embree, which sees them in floats.
#pragma once

#include <cmath>

#include "field/math/box3.h"

namespace marrow {

/// Of boxes within `bounds` with the origin moved to `middle`: so many roundings of floats there, and 16 of doubles in
/// the scene.
inline double margin_of_floats(const Box3& bounds, const Vec3d& middle, double roundings) {
  if (bounds.empty()) return 0;
  const double seen = largest_coordinate({bounds.lower - middle, bounds.upper - middle});
  return std::ldexp(roundings * seen, -24) + std::ldexp(16 * largest_coordinate(bounds), -52);
}

}  // namespace marrow
