// The place of a skeleton with the smallest scaled distance; internal to skeleton/.
#pragma once

#include "field/description/field_node.h"

namespace marrow {

struct NearestPlace {
  Vec3d to_point;  ///< p less the place, which loses nothing however far both are from the origin
  double radius;
  bool moves;  ///< with p; false at ends and corners
};
NearestPlace nearest_place(const SegmentSkeleton&, const Vec3d& p);
NearestPlace nearest_place(const ArcSkeleton&, const Vec3d& p);

}  // namespace marrow
