// The integral along a line under the compact kernel over numbers with second derivatives; internal to skeleton/.
#pragma once

#include "field/skeleton/second_order.h"

namespace marrow {

/// The field of a segment under the compact kernel; `share`: each place times how far along it is, from 0 to 1.
/// The ends of the support move with p, and the second derivatives of a kernel of low degree are infinite there. So the
/// nodes move too (compact_rule.h), by a variable in which the kernel is a power of what is smooth in p.
SecondOrderSample compact_line(const SegmentSkeleton&, const Vec3d& p, const Kernel&, bool share = false);

}  // namespace marrow
