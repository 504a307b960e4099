#include "field/tree/nodes/bend.h"

#include <algorithm>
#include <cmath>

#include "field/tree/nodes/cylinder_hull.h"

namespace marrow {

// A child point at `along` the axis and `height` over it ends at the distance |height| from the arc, or, behind an end
// of the arc, at most hypot(height, overhang) from that end; and the arc is no farther from its middle than it is long.
// Across the plane of the arc nothing moves.
Box3 Bend::support(const Box3& child) const {
  const auto hull = CylinderHull::of(child, center, axis);
  const UnitVec3 side = normalize(cross(axis.vec(), across()));
  const auto extent = CylinderHull::of(child, center, side);
  if (!hull || !extent) return everywhere();
  const double farthest = std::max(std::fabs(hull->bottom), std::fabs(hull->top));
  const double overhang = std::max(0.0, farthest - length / 2);
  const double reach = std::min(farthest, length / 2) + std::sqrt(hull->radius * hull->radius + overhang * overhang);
  return CylinderHull{extent->bottom, extent->top, reach}.box(center, side);
}

namespace {

// Of the place (u, v), to within what quotients, root and arc tangent round, half an ulp or one each. In units of its
// larger coordinate, as squares may vanish.
Interval angle_at(double v, double u) {
  const double unit = std::max(std::fabs(u), std::fabs(v)), x = u / unit, y = v / unit;
  const double r = std::sqrt(x * x + y * y), angle = 2 * marrow::atan(x < 0 ? (r - x) / y : y / (r + x));
  const double off = 8 * rounding::ulp * std::fabs(angle);
  return {rounding::down(angle - off), rounding::up(angle + off)};
}

}  // namespace

// Extreme at corners of a box that the cut does not run through: with y positive it falls along x, with x negative it
// falls along y.
Interval Bend::angle_over(const Interval& y, const Interval& x) {
  const double most = std::numbers::pi * (1 + 1e-15);
  if (is_cut(y, x)) return {-most, most};
  const double least_at = y.lo > 0 ? x.hi : x.lo, most_at = y.hi < 0 ? x.hi : x.lo;
  const Interval all(angle_at(least_at < 0 ? y.hi : y.lo, least_at).lo,
                     angle_at(most_at < 0 ? y.lo : y.hi, most_at).hi);
  return clamped(all, {-most, most});
}

// Of the corner that is farthest from the cut.
double Bend::least_angle_at_cut(const Interval& y, const Interval& x) {
  if (!(x.hi < 0)) return 0;
  const double off = std::max(-y.lo, y.hi);
  return std::max(0.0, std::numbers::pi - marrow::atan(off / -x.hi) - 1e-14);
}

}  // namespace marrow
