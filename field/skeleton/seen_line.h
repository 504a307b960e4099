// A segment as a line seen from a point.
#pragma once

#include "field/description/field_node.h"
#include "field/skeleton/reach.h"

namespace marrow {

struct SeenLine {
  double length, foot;
  UnitVec3 along;
  Vec3d across;
  Line line;
};

inline SeenLine seen_from(const SegmentSkeleton& s, const Vec3d& p) {
  const double length = marrow::length(s.to - s.from);
  const UnitVec3 u = UnitVec3::unchecked((s.to - s.from) / length);
  const double foot = dot(p - s.from, u), slope = (s.radius_to - s.radius_from) / length;
  const Vec3d across = p - s.from - u * foot;
  return {length, foot, u, across, {-foot, length - foot, length_squared(across), s.radius_from + slope * foot, slope}};
}

/// Where the inverse kernel is infinite.
inline bool is_on_line(const Line& line, const Kernel& kernel) {
  return kernel.family == KernelFamily::Inverse && line.h_squared == 0 && line.t1 <= 0 && line.t2 >= 0;
}

}  // namespace marrow
