#include "field/tree/extent.h"

namespace marrow {

Box3 disc_box(const Vec3d& center, const UnitVec3& axis, double radius) {
  // Along coordinate i it reaches radius sqrt(1 - a_i^2): the root of the other squares, which does not cancel.
  const Vec3d a = axis.vec();
  const auto side = [&](double b, double c) { return radius * std::sqrt(b * b + c * c); };
  const Vec3d sides{side(a.y, a.z), side(a.z, a.x), side(a.x, a.y)};
  return {center - sides, center + sides};
}

Box3 reached(const Box3& box, double reach) {
  double largest = reach;
  for (std::size_t i = 0; i < 3; ++i)
    for (const double x : {box.lower[i], box.upper[i]})
      if (std::isfinite(x)) largest = std::max(largest, std::fabs(x));
  return box.padded(reach + 1e-12 * largest);
}

}  // namespace marrow
