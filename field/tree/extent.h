// Boxes around the shapes of primitives.
#pragma once

#include "field/math/box3.h"

namespace marrow {

/// Box of a flat disc across `axis`; exact.
Box3 disc_box(const Vec3d& center, const UnitVec3& axis, double radius);

/// Box of all points within `reach` of what fills `box`, and a little more: relative 1e-12 of the largest finite
/// coordinate, far above what rounding moves a distance.
Box3 reached(const Box3& box, double reach);

}  // namespace marrow
