#include "field/tree/nodes/twist.h"

namespace marrow {

Box3 Twist::support(const Box3& child) const {
  double reach = 0, top = -Box3::inf, bottom = Box3::inf;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d v = Vec3d{corner & 1 ? child.lower.x : child.upper.x, corner & 2 ? child.lower.y : child.upper.y,
                          corner & 4 ? child.lower.z : child.upper.z} -
                    center;
    const double along = dot(axis, v);
    reach = std::max(reach, length(v - axis * along));
    top = std::max(top, along);
    bottom = std::min(bottom, along);
  }
  if (!(reach < Box3::inf)) return {{-Box3::inf, -Box3::inf, -Box3::inf}, {Box3::inf, Box3::inf, Box3::inf}};
  Box3 box;
  for (const double along : {bottom, top}) box.include(center + axis * along);
  // A disc of this radius across the axis reaches radius * sqrt(1 - a_i^2) along coordinate i.
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = reach * std::sqrt(std::max(0.0, 1 - axis.vec()[i] * axis.vec()[i])) * (1 + 1e-12);
    box.lower[i] -= side;
    box.upper[i] += side;
  }
  return box;
}

}  // namespace marrow
