// What of the segments by distance of a blend counts in a part of space.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "field/blend/blend_field.h"
#include "field/math/vec3.h"
#include "field/number/interval.h"
#include "field/skeleton/segment_place.h"

namespace marrow {

/// Lengths are those of the blend.
struct Ball {
  Vec3d center;
  double radius;
};

/// A segment of a strand, seen from a ball.
struct SeenSegment {
  std::size_t index;   ///< in the strand
  SegmentPlace place;  ///< the nearest one to the middle
  Interval scaled;     ///< least distance over the radius there, from anywhere in the ball
};

/// Finds the segments of which the scaled distance may be the least of a strand, and less than that from which on there
/// is no field, somewhere in a ball.
class NearestSegments {
 public:
  NearestSegments(const Kernel&, const Ball&);
  /// In their order; until the next strand is asked for.
  std::span<const SeenSegment> of(std::span<const SegmentSkeleton> strand);

 private:
  Ball ball_;
  double support_;
  std::vector<SeenSegment> seen_;
};

/// What stands for the segments by distance in a ball, with the same field.
struct DistancesInReach {
  PrimitiveList<SegmentSkeleton> segments;  ///< with their strands; without materials and angles
  std::vector<PointSkeleton> ends;          ///< for strands of which the ball sees nothing else
};
DistancesInReach distances_in_reach(const PrimitiveList<SegmentSkeleton>&, const Kernel&, const Ball&);

}  // namespace marrow
