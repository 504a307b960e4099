// Least distances from a point to skeletons.
#pragma once

#include "field/description/field_node.h"

namespace marrow {

double distance_to(const PointSkeleton&, const Vec3d& p);
double distance_to(const SegmentSkeleton&, const Vec3d& p);
double distance_to(const TriangleSkeleton&, const Vec3d& p);
double distance_to(const ArcSkeleton&, const Vec3d& p);

}  // namespace marrow
