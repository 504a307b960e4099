// Bounds of angles that are means over skeletons or over pairs of strands, to second order; internal to blend/.
#pragma once

#include <optional>

#include "field/blend/alpha_bounds.h"

namespace marrow {

/// Of a blend of integrals under the inverse or the Cauchy kernel that has `alpha_per_skeleton` or `direction_bounds`:
/// the angle and its gradient in the middle, and how fast both change in the box. Nothing for other primitives, near
/// skeletons, and where weights leave the range of doubles.
std::optional<AngleBounds> mean_angles(const BlendField&, const SumBounds&);

}  // namespace marrow
