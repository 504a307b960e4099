// Ways to the field of a triangle (for several radii under bounded kernels see even_lines.h, too); internal to
// skeleton/, and for tests of one against the other.
#pragma once

#include <optional>

#include "field/description/field_node.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// Gauss-Legendre over lines parallel to a side, each line in closed form; for any radii. Beside a wide triangle some
/// 10^4 nodes.
template <Derivatives>
SkeletonSample triangle_by_lines(const TriangleSkeleton&, const Vec3d& p, int family_degree);

/// Integrals along its three sides, some hundred nodes each.   [tapered_plate.h]
/// Nothing where the triangle is narrow against its distance from p, so that what its sides give would cancel: there
/// lines are few. Nor where a radius that varies would take more than three digits.
template <Derivatives>
std::optional<SkeletonSample> triangle_by_sides(const TriangleSkeleton&, const Vec3d& p, int family_degree);

/// The same under any kernel; under the Cauchy and the compact one nodes of the adaptive rules of surface_integral.h,
/// and by its sides some hundred nodes for one radius alone. [compact_plate.h]
template <Derivatives>
SkeletonSample triangle_by_lines(const TriangleSkeleton&, const Vec3d& p, const Kernel&);
template <Derivatives>
std::optional<SkeletonSample> triangle_by_sides(const TriangleSkeleton&, const Vec3d& p, const Kernel&);

}  // namespace marrow
