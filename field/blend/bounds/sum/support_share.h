// How much of a skeleton the support of a compact kernel holds; internal to blend/.
#pragma once

#include "field/description/field_node.h"

namespace marrow {

/// What a primitive can hold of its skeleton within a distance of any point, at most; here and below over its least
/// radius to the power of its dimension.
double share_within(const PointSkeleton&, double reach);
double share_within(const SegmentSkeleton&, double reach);
double share_within(const ArcSkeleton&, double reach);
double share_within(const TriangleSkeleton&, double reach);

/// How much of it may come into the support of R radii, or leave it, on a way of rho from p, at most: that whose
/// distance differs from R radii by so much. `anywhere`: from all places that lie along a segment from p.
double share_crossing(const PointSkeleton&, const Vec3d& p, double rho, double R, bool anywhere = false);
double share_crossing(const SegmentSkeleton&, const Vec3d& p, double rho, double R, bool anywhere = false);
double share_crossing(const ArcSkeleton&, const Vec3d& p, double rho, double R, bool anywhere = false);
double share_crossing(const TriangleSkeleton&, const Vec3d& p, double rho, double R, bool anywhere = false);

}  // namespace marrow
