// The share of the range of angles at a place, by the patch around it.
#pragma once

#include "field/math/vec3.h"
#include "field/trace/kernels/share_part.h"

namespace marrow {

/// A share, its gradient, and what bounds how it bends: |share(x + v) - share(x) - gradient . v| <= bend |v|^2 within
/// the part. It may lie a little beyond [0, 1], where the angle stays at an end of its range. In the coordinates of the
/// block.
struct ShareAt {
  double share = 0;
  Vec3d gradient;
  double bend = 0;
  double error = 0;  ///< as SharePatch::error
};
ShareAt share_at(const SharePatch&, const Vec3d& place);

}  // namespace marrow
