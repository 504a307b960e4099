// Bounds of angles that are means over skeletons or over pairs of strands, to second order; internal to blend/.
#pragma once

#include "field/blend/bounds/angle/alpha_bounds.h"

namespace marrow {

/// Of a blend that has `alpha_per_skeleton` or `direction_bounds`, from bounds of its sums with their parts: the angle
/// (radians) and its gradient in the middle, and how fast both change in the box. Where nothing of that is known (near
/// skeletons, where weights leave the range of doubles, where an angle or a direction may jump) all angles of the
/// blend, with any gradient.   [Zanni et al. 2015, eq. 15]
AngleBounds mean_angles(const BlendField&, const SumBounds&);

}  // namespace marrow
