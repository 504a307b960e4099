// Bounds of the partial derivatives of the correction operator for angles below 0; internal to blend/.
#pragma once

#include "field/blend/bounds/correction/correction_bounds.h"

namespace marrow {

/// As partial_bounds(), of a correction of the inverse kernel with the least of these angles, all from -1 to 0. Where C
/// is guarded, cut at 0 or behind the critical point its derivatives jump: every piece that the intervals meet counts.
/// Behind the critical point they are known for a single angle only, and dC/dalpha is not.
///
/// With k = tan |alpha|, s the slope of the chord, C as projected falls with f and rises with G:
///   dC/df = -k (2 s - k - g'(f)) / (s - k)^2,   dC/dG = (s^2 / g'(x_H) - k) / (s - k)^2,
///   dC/dalpha = s (f - x_H) (1 + k^2) / (s - k)^2
/// where s >= 2 k, that is unguarded; 2 s - k >= 3/2 s, and s >= (n-1)/n g'(f). Guarded they are -1, 2 / g'(x_H), 0.
/// Behind the critical point C falls with a, half the way between the two skeletons of M_d.   [Zanni et al. 2015, 4.2]
PartialBounds partials_below_zero(const Correction& least, const Interval& alpha, const Interval& value,
                                  const Interval& f, const Interval& G);

}  // namespace marrow
