// The sum of the primitives and the projection angle at a point, from one evaluation of each primitive; internal to
// blend/.
#pragma once

#include "field/blend/blend_field.h"

namespace marrow {

struct Gathered {
  SkeletonSample sum;
  AlphaSample alpha;  ///< its gradient from Derivatives::First on
};

template <Derivatives>
Gathered gather(const BlendField&, const Vec3d& p);

}  // namespace marrow
