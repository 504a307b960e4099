// Field of a triangle whose radius varies under the compact kernel; internal to skeleton/.
#pragma once

#include "field/description/field_node.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// Over some hundred lines of one radius each.   [compact_chord.h]
/// Precondition: the radii differ.
template <Derivatives>
SkeletonSample compact_taper_field(const TriangleSkeleton&, const Vec3d& p, const Kernel&);

}  // namespace marrow
