// The sum of the primitives and the projection angle at a point, with second derivatives; internal to blend/.
#pragma once

#include "field/blend/blend_field.h"
#include "field/skeleton/second_order.h"

namespace marrow {

struct SecondOrderGathered {
  SecondOrderSample sum;
  HessianJet alpha;
};
SecondOrderGathered second_order_gather(const BlendField&, const Vec3d& p);

}  // namespace marrow
