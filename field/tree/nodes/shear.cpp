#include "field/tree/nodes/shear.h"

#include "field/tree/nodes/cylinder_hull.h"

namespace marrow {

// The corners of the box, moved; `step` is across the axis, so that heights stay.
Box3 Shear::support(const Box3& child) const {
  if (!is_finite(child.lower) || !is_finite(child.upper)) return everywhere();
  Box3 moved;
  for (const Vec3d& p : corners_of(child)) moved.include(p + step() * dot(p - center, axis));
  return moved.padded(1e-12 * (1 + std::fabs(amount)) * (largest_coordinate(child) + max_component(abs(center))));
}

}  // namespace marrow
