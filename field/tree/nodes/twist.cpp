#include "field/tree/nodes/twist.h"

#include "field/tree/nodes/cylinder_hull.h"

namespace marrow {

Box3 Twist::support(const Box3& child) const {
  const auto hull = CylinderHull::of(child, center, axis);
  return hull ? hull->box(center, axis) : everywhere();
}

}  // namespace marrow
