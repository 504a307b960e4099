// Bounds of the partial derivatives of the correction operator for angles below 0; internal to blend/.
#pragma once

#include "field/blend/correction_bounds.h"

namespace marrow {

/// As partial_bounds(), of a correction of the inverse kernel with alpha < 0; dC/dalpha is not known. Where C is
/// guarded, cut at 0 or behind the critical point its derivatives jump: every piece that the intervals meet counts.
///
/// With t = -sin alpha, w = s cos alpha, s the slope of the chord, C as projected falls with f and rises with G:
///   dC/df = -t (2 w - t - g'(f) cos alpha) / (w - t)^2,   dC/dG = (w^2 / g'(x_H) - t cos alpha) / (w - t)^2,
/// where w >= 2 t, that is unguarded; 2 w - t >= 3/2 w, and s >= (n-1)/n g'(f). Guarded they are -1 and 2 / g'(x_H).
/// Behind the critical point C falls with a, half the way between the two skeletons of M_d.   [field-maths 4.4, 4.5, 5]
PartialBounds partials_below_zero(const Correction&, const Interval& value, const Interval& f, const Interval& G);

}  // namespace marrow
