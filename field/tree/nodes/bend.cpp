#include "field/tree/nodes/bend.h"

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

// Extreme at corners of a box without the origin.
Interval Bend::angle_over(const Interval& y, const Interval& x) {
  const double most = std::numbers::pi * (1 + 1e-15);
  if (is_cut(y, x)) return {-most, most};
  const auto corner = [](double v, double u) {
    const Interval Y = v, X = u, r = sqrt(square(X) + square(Y));
    return Interval(2) * (u < 0 ? atan((r - X) / Y) : atan(Y / (r + X)));
  };
  const Interval all = hull(hull(corner(y.lo, x.lo), corner(y.lo, x.hi)), hull(corner(y.hi, x.lo), corner(y.hi, x.hi)));
  return clamped(all, {-most, most});
}

// Of the corner that is farthest from the cut.
double Bend::least_angle_at_cut(const Interval& y, const Interval& x) {
  if (!(x.hi < 0)) return 0;
  const double off = std::max(-y.lo, y.hi);
  return std::max(0.0, std::numbers::pi - marrow::atan(off / -x.hi) - 1e-14);
}

}  // namespace marrow
