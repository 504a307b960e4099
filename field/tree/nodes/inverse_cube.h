// The integral of 1/r^3 along a piece of a line: Cani and Hornus' convolution of a segment.
#pragma once

#include "field/number/functions.h"

namespace marrow {

namespace inverse_cube {

/// Partial derivatives by h2, t1 and t2.
struct Partials {
  Interval h2, t1, t2;
};
Partials partials(const Interval& h2, const Interval& t1, const Interval& t2);

/// For h2 > 0, t1 <= t2. With d = sqrt(h2 + t^2) it is (t2/d2 - t1/d1) / h2; where the foot is outside, this is
/// (t2^2 - t1^2) / (d1 d2 (|t2| d1 + |t1| d2)), which is not 0/0 on the line.
template <Number X>
X formula(const X& h2, const X& t1, const X& t2) {
  const X d1 = sqrt(h2 + square(t1)), d2 = sqrt(h2 + square(t2));
  if (lower(t1) <= 0 && upper(t2) >= 0) return (t2 / d2 - t1 / d1) / h2;
  return (t2 - t1) * abs(t1 + t2) / (d1 * d2 * (abs(t2) * d1 + abs(t1) * d2));
}

}  // namespace inverse_cube

/// The integral of (h2 + t^2)^(-3/2) from t1 to t2; 0 where t2 <= t1. h2 > 0 is the squared distance from the line.
/// Falls with h2 and t1, rises with t2, which gives its enclosures.
template <Number X>
X inverse_cube_integral(const X& h2, const X& t1, const X& t2) {
  if (upper(t2) <= lower(t1)) return X(0.0);
  if constexpr (!is_enclosure<X>) {
    return inverse_cube::formula(h2, t1, t2);
  } else if constexpr (!JetNumber<X>) {
    const auto at = [](double h, double a, double b) {
      return b > a ? inverse_cube::formula(Interval(h), Interval(a), Interval(b)) : Interval(0);
    };
    return {std::max(0.0, at(h2.hi, t1.hi, t2.lo).lo), std::max(0.0, at(h2.lo, t1.lo, t2.hi).hi)};
  } else {
    X r(inverse_cube_integral(h2.value, t1.value, t2.value));
    const auto d = inverse_cube::partials(h2.value, t1.value, t2.value);
    for (std::size_t i = 0; i < r.slope.size(); ++i)
      r.slope[i] = d.h2 * h2.slope[i] + d.t1 * t1.slope[i] + d.t2 * t2.slope[i];
    return r;
  }
}

}  // namespace marrow
