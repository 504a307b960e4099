// The cylinder about an axis that holds a box: what warps that keep to an axis do with supports.
#pragma once

#include <optional>

#include "field/math/box3.h"

namespace marrow {

inline Box3 everywhere() { return {{-Box3::inf, -Box3::inf, -Box3::inf}, {Box3::inf, Box3::inf, Box3::inf}}; }

/// Points center + axis t + v with bottom <= t <= top and v across the axis, |v| <= radius.
struct CylinderHull {
  double bottom = 0, top = 0, radius = 0;

  /// Nothing for a box with an infinite side. An empty box counts as the box of its two corners.
  static std::optional<CylinderHull> of(const Box3&, const Vec3d& center, const UnitVec3& axis);
  Box3 box(const Vec3d& center, const UnitVec3& axis) const;
};

}  // namespace marrow
