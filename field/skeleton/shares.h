// What else is integrated along a segment: how its field is shared between its ends.
#pragma once

#include "field/description/field_node.h"
#include "field/math/vec3.h"

namespace marrow {

/// (1/N) integral of the kernel times s, with s from 0 at the begin to 1 at the end of the skeleton, and its gradient.
/// A quantity that is linear along the skeleton, a + (b - a) s, has the mean a + (b - a) value / f under the field f;
/// cutting the skeleton anyhow does not change it. On the skeleton: 0.
struct ShareSample {
  double value = 0;
  Vec3d gradient{};
};
ShareSample segment_share(const SegmentSkeleton&, const Vec3d& p, const Kernel&);

}  // namespace marrow
