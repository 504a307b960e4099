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

}  // namespace marrow
