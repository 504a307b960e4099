// Bounds of a projection angle that varies in space.
#pragma once

#include "field/blend/sum_bounds.h"

namespace marrow {

/// All angles that the blend may use in the box of `sum`.
Interval alpha_bounds(const BlendField&, const SumBounds& sum, const Box3&);

}  // namespace marrow
