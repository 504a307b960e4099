#include "field/tree/nodes/taper.h"

#include "field/tree/nodes/cylinder_hull.h"

namespace marrow {

// Exact for the extent along the axis; across it the widest factor between bottom and top.
Box3 Taper::support(const Box3& child) const {
  auto hull = CylinderHull::of(child, center, axis);
  if (!hull) return everywhere();
  const auto width = [&](double along) { return start + (end - start) * std::clamp(along / length, 0.0, 1.0); };
  hull->radius *= std::max(width(hull->bottom), width(hull->top));
  return hull->box(center, axis);
}

}  // namespace marrow
