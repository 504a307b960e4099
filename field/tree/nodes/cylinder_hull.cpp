#include "field/tree/nodes/cylinder_hull.h"

namespace marrow {

std::optional<CylinderHull> CylinderHull::of(const Box3& box, const Vec3d& center, const UnitVec3& axis) {
  if (!is_finite(box.lower) || !is_finite(box.upper)) return {};
  CylinderHull hull{Box3::inf, -Box3::inf, 0};
  for (const Vec3d& p : corners_of(box)) {
    const Vec3d v = p - center;
    const double along = dot(axis, v);
    hull.radius = std::max(hull.radius, length(v - axis * along));
    hull.top = std::max(hull.top, along);
    hull.bottom = std::min(hull.bottom, along);
  }
  return hull;
}

Box3 CylinderHull::box(const Vec3d& center, const UnitVec3& axis) const {
  Box3 hull;
  for (const double along : {bottom, top}) hull.include(center + axis * along);
  // A disc of this radius across the axis reaches radius * sqrt(1 - a_i^2) along coordinate i. The margin is far above
  // the rounding of the few operations that led here, whose terms are at most this large.
  const double scale = radius + std::max(std::fabs(bottom), std::fabs(top)) + max_component(abs(center));
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = radius * std::sqrt(std::max(0.0, 1 - axis.vec()[i] * axis.vec()[i])) + 1e-12 * scale;
    hull.lower[i] -= side;
    hull.upper[i] += side;
  }
  return hull;
}

}  // namespace marrow
