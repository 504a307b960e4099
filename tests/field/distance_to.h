// How far skeletons are.
#pragma once

#include <algorithm>

#include "field/description/field_node.h"

namespace marrow::test {

/// To the nearest place of a segment, as written.
inline double distance_to(const SegmentSkeleton& s, const Vec3d& p) {
  const Vec3d along = s.to - s.from;
  const double at = std::clamp(dot(p - s.from, along) / length_squared(along), 0.0, 1.0);
  return length(p - s.from - along * at);
}

}  // namespace marrow::test
