// Bounds of a projection angle that varies in space.
#pragma once

#include "field/blend/bounds/sum/sum_bounds.h"

namespace marrow {

struct AngleBounds {
  Interval value;           ///< radians
  Vec3<Interval> gradient;  ///< everything where no bound is known
};
/// All angles that the blend may use in the box of `sum`, and their gradients.
AngleBounds alpha_bounds(const BlendField&, const SumBounds& sum, const Box3&);

}  // namespace marrow
