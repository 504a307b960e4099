// Certified bounds of a blend's corrected field over a box.
#pragma once

#include "field/blend/blend_field.h"
#include "field/blend/bounds/angle/alpha_bounds.h"
#include "field/blend/bounds/sum/sum_bounds.h"
#include "field/blend/correction/correction.h"
#include "field/number/interval.h"

namespace marrow {

struct BlendBounds {
  Interval value;
  Vec3<Interval> gradient;                  ///< of the corrected field, everywhere in the box
  Interval along = Interval::everything();  ///< of a stretch, its slope along the direction
};

/// From one exact sample in the middle of the box and bounds of the derivatives of each primitive, which follow from
/// its least distance: widths shrink with the square of the box for the sums, linearly for the corrected field.
/// Boxes that reach a skeleton have no upper bound.
/// For Wanted::Value alone the gradient may be everything. Within a stretch or a skew box bounds are of its places
/// alone; the slope of a stretch stands in `along` instead of the gradient.
BlendBounds blend_bounds(const BlendField&, const Box3&, Wanted = Wanted::Slopes, const Within& = {});
/// The same from bounds of the sums and of the angle, and the correction of the least angle.
BlendBounds blend_bounds(const BlendField&, const SumBounds&, const AngleBounds&, const Correction& least);

/// The box outside which the corrected field is below `level`, or 0 for level = 0: all of space but for the compact
/// kernel.
Box3 blend_extent(const BlendField&, double level);

}  // namespace marrow
