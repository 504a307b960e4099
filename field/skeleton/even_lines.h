// Field of a triangle whose radius varies under the Cauchy and the compact kernel; internal to skeleton/.
#pragma once

#include "field/description/field_node.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// Over some hundred lines of one radius each, in closed form.   [compact_chord.h; segment_moments.h]
/// Precondition: the radii differ, and the kernel is one of these.
template <Derivatives>
SkeletonSample triangle_by_even_lines(const TriangleSkeleton&, const Vec3d& p, const Kernel&);

}  // namespace marrow
