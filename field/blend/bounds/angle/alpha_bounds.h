// Bounds of a projection angle that varies in space.
#pragma once

#include "field/blend/angle/alpha_sample.h"
#include "field/blend/bounds/angle/mean_bounds.h"
#include "field/blend/bounds/sum/sum_bounds.h"

namespace marrow {

struct AngleBounds {
  Interval value;           ///< radians
  Vec3<Interval> gradient;  ///< everything where no bound is known
};
/// From an angle and its gradient in the middle to anywhere in the box, or on the stretch, from how fast both change
/// there; within `range` in any case.
AngleBounds angles_around(const AlphaSample& middle, const MeanChange&, const Interval& range, const SumBounds&);
/// All angles that the blend may use in the box of `sum`, and their gradients.
AngleBounds alpha_bounds(const BlendField&, const SumBounds& sum, const Box3&);

}  // namespace marrow
