// Fields of single skeleton primitives under the inverse kernel family.
#pragma once

#include "field/description/field_node.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// All: radii > 0, family_degree in [min_kernel_degree, max_kernel_degree]; p and the skeleton in the same units.

/// f = (radius / d)^(n-1).   [field-maths 3.1]
template <Derivatives>
SkeletonSample point_field(const PointSkeleton&, const Vec3d& p, int family_degree);

/// Integral of the kernel along the segment (SCALIS); relative error below 1e-13 away from the skeleton.
/// A segment of length 0 has no field.   [field-maths 3.3]
template <Derivatives>
SkeletonSample segment_field(const SegmentSkeleton&, const Vec3d& p, int family_degree);

/// Kernel of the smallest scaled distance min_q |p - q| / radius(q).   [field-maths 3.2]
template <Derivatives>
SkeletonSample distance_segment_field(const SegmentSkeleton&, const Vec3d& p, int family_degree);

}  // namespace marrow
