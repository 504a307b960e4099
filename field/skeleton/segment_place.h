// The place of a segment of linear radius with the smallest scaled distance from a point; internal to the library.
#pragma once

#include "field/description/field_node.h"

namespace marrow {

/// What leads from the place to the point is made of differences from an end, so that it loses nothing however far both
/// are from the origin.
struct SegmentPlace {
  Vec3d to_point;
  double radius;
  double along;    ///< from the begin, over the length
  bool is_inside;  ///< not an end: the scaled distance is stationary there

  double scaled_squared() const { return length_squared(to_point) / (radius * radius); }
};

/// With p at height h over the line and t from its foot, e^2 = (t^2 + h^2) / (tau_f + sigma t)^2 is stationary at
/// t = sigma h^2 / tau_f, a minimum where tau_f > 0. `size` and `u`: length and direction of the segment.
inline SegmentPlace segment_place(const SegmentSkeleton& s, const Vec3d& p, double size, const Vec3d& u) {
  const Vec3d from_start = p - s.from;
  const double foot = dot(from_start, u), slope = (s.radius_to - s.radius_from) / size;
  const double foot_radius = s.radius_from + slope * foot;
  if (foot_radius > 0) {
    const Vec3d across = from_start - u * foot;
    const double ahead = slope * length_squared(across) / foot_radius, t = foot + ahead;
    if (t > 0 && t < size) return {across - u * ahead, s.radius_from + slope * t, t / size, true};
  }
  const SegmentPlace start{from_start, s.radius_from, 0, false}, end{p - s.to, s.radius_to, 1, false};
  return end.scaled_squared() < start.scaled_squared() ? end : start;
}

}  // namespace marrow
