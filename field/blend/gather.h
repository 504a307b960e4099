// The sum of the primitives and the projection angle at a point, from one evaluation of each primitive; internal to
// blend/.
#pragma once

#include <vector>

#include "field/blend/angle/local_contact.h"
#include "field/blend/blend_field.h"
#include "field/blend/primitive_bounds.h"
#include "field/skeleton/shares.h"

namespace marrow {

struct Gathered {
  SkeletonSample sum;
  AlphaSample alpha;  ///< its gradient from Derivatives::First on
};

/// What the rule of local contact is told at p, from the samples of the parts there; and, if it adapts to density, the
/// near field of each part.
struct PartsAround {
  Neighbourhood place;
  std::vector<SkeletonSample> near;
};
PartsAround parts_around(const BlendField&, const Vec3d& p, const std::vector<PrimitiveBounds>&);

/// The angle of a blend that has `alpha_per_skeleton`, from the samples of its parts at p. All segments of a strand by
/// distance count that have a sample.
AlphaSample alpha_of_skeletons(const BlendField&, const Vec3d& p, const std::vector<PrimitiveBounds>&);
/// The sum of the directions of each part at p, weighted by its field; and the angle of a blend that has
/// `direction_bounds`, which follows from these and the samples.
std::vector<DirectionSample> directions_of(const BlendField&, const Vec3d& p, const std::vector<PrimitiveBounds>&);
AlphaSample alpha_of_directions(const BlendField&, const std::vector<PrimitiveBounds>&,
                                const std::vector<DirectionSample>&);

template <Derivatives>
Gathered gather(const BlendField&, const Vec3d& p);

}  // namespace marrow
