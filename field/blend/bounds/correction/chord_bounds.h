// Bounds of chords of the reference curve of the inverse kernel; internal to blend/.
#pragma once

#include <algorithm>
#include <cmath>

#include "field/kernel/inverse_family.h"
#include "field/number/interval.h"

namespace marrow {

/// Slope of the chord of the convex curve g between two of its points; isotone in both.
inline Interval chord_slope(const ReferenceCurve& curve, const Interval& a, const Interval& b) {
  const auto slope = [&](double x, double y) {
    if (std::fabs(x - y) < 1e-4 * std::max(x, y)) return curve.slope(0.5 * (x + y));
    return (curve.at(x) - curve.at(y)) / (x - y);
  };
  // Near the diagonal the slope in the middle is off by (1e-4)^2 / 24 g'''/g' < 1e-8, farther the difference loses
  // 1e-11.
  return {slope(a.lo, b.lo) * (1 - 1e-8), slope(a.hi, b.hi) * (1 + 1e-8)};
}

/// The places at which the curve has the heights G.
inline Interval x_H_of(const ReferenceCurve& curve, const Interval& G) {
  return {curve.inverse(G.lo) * (1 - 1e-12), curve.inverse(G.hi) * (1 + 1e-12)};
}

/// g' there.
inline Interval slope_of(const ReferenceCurve& curve, const Interval& x) {
  return {curve.slope(x.lo) * (1 - 1e-12), curve.slope(x.hi) * (1 + 1e-12)};
}

}  // namespace marrow
