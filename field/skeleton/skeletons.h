// Fields of single skeleton primitives.
#pragma once

#include "field/description/field_node.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// Under the inverse kernel family, where the kernel is given by its degree. All: radii > 0, family_degree in
/// [min_kernel_degree, max_kernel_degree]; p and the skeleton in the same units.

/// f = (radius / d)^(n-1).
template <Derivatives>
SkeletonSample point_field(const PointSkeleton&, const Vec3d& p, int family_degree);

/// Integral of the kernel along the segment (SCALIS); relative error below 1e-13 away from the skeleton.
/// A segment of length 0 has no field.   [Zanni et al. 2013]
template <Derivatives>
SkeletonSample segment_field(const SegmentSkeleton&, const Vec3d& p, int family_degree);

/// Integral of the kernel over the triangle, radius linear; relative error below 1e-12. A triangle without area has no
/// field. Some hundred nodes along each side where p is near, else some lines of segment_field.
template <Derivatives>
SkeletonSample triangle_field(const TriangleSkeleton&, const Vec3d& p, int family_degree);

/// Integral of the kernel along the arc or circle, radius linear in the angle.
template <Derivatives>
SkeletonSample arc_field(const ArcSkeleton&, const Vec3d& p, int family_degree);

/// Kernel of the smallest scaled distance min_q |p - q| / radius(q).   [Zanni et al. 2015, eq. 4]
template <Derivatives>
SkeletonSample distance_segment_field(const SegmentSkeleton&, const Vec3d& p, int family_degree);

/// Cani and Hornus 2001: (sin a_2 - sin a_1) R^2 / (2 h^2), the integral of 1/r^3 with one radius R all along, that at
/// the foot of p on the segment (clamped to its ends). For a constant radius it is segment_field with family degree 3;
/// else it is not an integral, and cutting a segment changes it. grad_S f takes R as constant.
template <Derivatives>
SkeletonSample cani_hornus_field(const SegmentSkeleton&, const Vec3d& p);

/// Kernel of the smallest scaled distance, under any kernel.   [Zanni et al. 2015, eq. 4]
/// A curve whose radius varies may have several nearest places; the field is continuous where they change.
template <Derivatives>
SkeletonSample distance_field(const SegmentSkeleton&, const Vec3d& p, const Kernel&);
template <Derivatives>
SkeletonSample distance_field(const TriangleSkeleton&, const Vec3d& p, const Kernel&);
template <Derivatives>
SkeletonSample distance_field(const ArcSkeleton&, const Vec3d& p, const Kernel&);

/// The integrals under the Cauchy or the compact kernel (kernel.family is not the inverse one); finite everywhere.
/// A segment costs some panels of 20 nodes, under compact kernels of even degree one of 3 to 12, or none for one radius
/// (compact_rule.h, compact_chord.h); an arc some hundred nodes, a triangle of one radius as many along each side
/// (compact_plate.h), of several radii some hundred lines (even_lines.h), in pieces between the places where the edge
/// of the support cuts it (support_edge.h). Relative error below 1e-12, and 1e-11 of triangles a thousand radii
/// wide, where the skeleton is no shorter than a thousandth of its radius.
template <Derivatives>
SkeletonSample point_field(const PointSkeleton&, const Vec3d& p, const Kernel&);
template <Derivatives>
SkeletonSample segment_field(const SegmentSkeleton&, const Vec3d& p, const Kernel&);
template <Derivatives>
SkeletonSample arc_field(const ArcSkeleton&, const Vec3d& p, const Kernel&);
template <Derivatives>
SkeletonSample triangle_field(const TriangleSkeleton&, const Vec3d& p, const Kernel&);

}  // namespace marrow
