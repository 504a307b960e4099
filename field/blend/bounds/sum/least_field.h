// What a skeleton has of a field at least; internal to blend/.
#pragma once

#include "field/description/field_node.h"
#include "field/kernel/profile.h"

namespace marrow {

/// Of its integral, anywhere in the ball of `rho` around the center, which may hold the skeleton itself.
double least_field(const SegmentSkeleton&, const Profile&, const Vec3d& center, double rho);
double least_field(const ArcSkeleton&, const Profile&, const Vec3d& center, double rho);
double least_field(const TriangleSkeleton&, const Profile&, const Vec3d& center, double rho);

}  // namespace marrow
