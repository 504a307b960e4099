// Whether an enclosure of a piece of a ray is a straight line.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "field/blend/bounds/sum/sum_bounds.h"
#include "field/number/jet.h"

namespace marrow::tree {

/// The way of a ray that no warp has bent: its slopes have no width but rounding, and the sides of its box are as long
/// as these say. Intervals keep the middle of what maps of such slopes, which are affine, make of a line, so that it is
/// the diagonal of the box. Nothing where that is not so; then the box is all that is known.
inline std::optional<Stretch> straight_way(const Vec3<Jet<Interval, 1>>& p) {
  constexpr double roundings = 64 * rounding::ulp;
  Vec3d half, direction;
  double coordinates = 0, speed = 0, time = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    direction[i] = p[i].slope[0].middle();
    half[i] = 0.5 * p[i].value.width();
    coordinates = std::max({coordinates, std::fabs(p[i].value.lo), std::fabs(p[i].value.hi)});
    if (std::fabs(direction[i]) > speed) {
      speed = std::fabs(direction[i]);
      time = half[i] / speed;
    }
  }
  const double slack = roundings * coordinates;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(p[i].slope[0].width() <= roundings * speed)) return {};
    if (!(std::fabs(half[i] - std::fabs(direction[i]) * time) <= slack)) return {};
  }
  return Stretch{direction * time, direction, slack};
}

}  // namespace marrow::tree
