// The sum of the primitives and the projection angle at a point, from one evaluation of each primitive; internal to
// blend/.
#pragma once

#include <optional>
#include <vector>

#include "field/blend/angle/local_contact.h"
#include "field/blend/blend_field.h"
#include "field/blend/primitive_bounds.h"

namespace marrow {

struct Gathered {
  SkeletonSample sum;
  AlphaSample alpha;  ///< its gradient from Derivatives::First on
};

/// What the rule of local contact is told at p, with no gradients. Nothing where the sum is 0 or infinite.
std::optional<Neighbourhood> neighbourhood_at(const BlendField&, const Vec3d& p);

/// The angle of a blend that has `alpha_per_skeleton` or `direction_bounds`, from the samples of its parts at p. All
/// segments of a strand by distance count that have a sample.
AlphaSample alpha_of(const BlendField&, const Vec3d& p, const std::vector<PrimitiveBounds>&);

template <Derivatives>
Gathered gather(const BlendField&, const Vec3d& p);

}  // namespace marrow
