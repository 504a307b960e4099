// By how much boxes are padded: for Embree, which sees them in floats, and for our own doubles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "field/math/box3.h"

namespace marrow {

/// Of boxes within `bounds` with the origin moved to `middle`: so many roundings of floats there, and 16 of doubles in
/// the scene.
inline double margin_of_floats(const Box3& bounds, const Vec3d& middle, double roundings) {
  if (bounds.empty()) return 0;
  const double seen = largest_coordinate({bounds.lower - middle, bounds.upper - middle});
  return std::ldexp(roundings * seen, -24) + std::ldexp(16 * largest_coordinate(bounds), -52);
}

/// What doubles need of it: rays that pass by what is much smaller than the scene are not to ask for it. A 64th of the
/// box covers what a ray's own coordinates round, some 10^13 boxes from its origin; 16 roundings those of the box.
inline double margin_of_doubles(const Box3& box, double margin_of_floats) {
  const double own = std::ldexp(max_component(box.size()), -6),
               rounding = std::ldexp(16 * largest_coordinate(box), -52);
  return std::min(margin_of_floats, std::max(own, rounding));
}

/// A box as Embree sees it.
struct FloatBox {
  std::array<float, 3> lower, upper;
};

/// The padded box with the origin moved to `middle`, rounded outward.
inline FloatBox box_in_floats(const Box3& box, const Vec3d& middle, double margin) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Box3 padded = Box3{box.lower - middle, box.upper - middle}.padded(margin);
  FloatBox in_floats;
  for (std::size_t k = 0; k < 3; ++k) {
    in_floats.lower[k] = std::nextafter(static_cast<float>(padded.lower[k]), -infinity);
    in_floats.upper[k] = std::nextafter(static_cast<float>(padded.upper[k]), infinity);
  }
  return in_floats;
}

}  // namespace marrow
