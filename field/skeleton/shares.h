// What else is known along a skeleton: how its field is shared between its nodes, and the direction of an arc.
#pragma once

#include <array>

#include "field/description/field_node.h"
#include "field/math/matrix3.h"
#include "field/math/vec3.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// (1/N) integral of the kernel times s, with s from 0 at the begin to 1 at the end of the skeleton, and its gradient.
/// A quantity that is linear along the skeleton, a + (b - a) s, has the mean a + (b - a) value / f under the field f;
/// cutting the skeleton anyhow does not change it. On the skeleton: 0.
struct ShareSample {
  double value = 0;
  Vec3d gradient{};
};
ShareSample segment_share(const SegmentSkeleton&, const Vec3d& p, const Kernel&);

/// Shares of the second and the third node: of the end and nothing, or of two corners of a triangle.
using Shares = std::array<ShareSample, 2>;
Shares integral_shares(const PointSkeleton&, const Vec3d& p, const Kernel&);
Shares integral_shares(const SegmentSkeleton&, const Vec3d& p, const Kernel&);
Shares integral_shares(const TriangleSkeleton&, const Vec3d& p, const Kernel&);
Shares integral_shares(const ArcSkeleton&, const Vec3d& p, const Kernel&);
/// Under the distance model the place that is nearest has all of the field, which is given with its gradient.
Shares nearest_shares(const SegmentSkeleton&, const Vec3d& p, const SkeletonSample& field);
Shares nearest_shares(const TriangleSkeleton&, const Vec3d& p, const SkeletonSample& field);
Shares nearest_shares(const ArcSkeleton&, const Vec3d& p, const SkeletonSample& field);
/// Under that of Cani and Hornus the foot of p has, as its radius counts.
Shares foot_shares(const SegmentSkeleton&, const Vec3d& p, const SkeletonSample& field);

/// (1/N) integral of the kernel times the tangent of length 1, toward growing angles: what many short segments in place
/// of the arc would sum to. On the arc: 0.
struct DirectionSample {
  Vec3d value{};
  Matrix3 jacobian{};
};
DirectionSample arc_direction(const ArcSkeleton&, const Vec3d& p, const Kernel&);
/// Under the distance model: the tangent where the arc is nearest, times the field.
DirectionSample nearest_direction(const ArcSkeleton&, const Vec3d& p, const SkeletonSample& field);

}  // namespace marrow
