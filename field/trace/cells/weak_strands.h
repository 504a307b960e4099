// The share of angles where floats do not tell the field of all strands but the strongest: by the blend itself.
#pragma once

#include "field/blend/blend_field.h"
#include "field/math/vec3.h"
#include "field/trace/shares/angle_field.h"

namespace marrow {

/// The share of the range of angles at a place, and its gradient.
struct AngleShare {
  double value = 0;
  Vec3d gradient;
};

/// The share by all primitives of a blend of points and segments with directions, in double. Their bounds lie in the
/// range.
AngleShare exact_share(const BlendField&, const AngleRange&, const Vec3d& p);

/// Such a blend of those strands alone that shares within the ball may depend on: all that is left out together is
/// below 1e-6 of the second strongest strand, over whose field a share is a mean.
BlendField counting_strands(const BlendField&, const Vec3d& center, double reach);

}  // namespace marrow
