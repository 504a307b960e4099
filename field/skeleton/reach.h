// Where the support of a compact kernel reaches along a line.
#pragma once

#include <cmath>
#include <optional>

#include "field/number/functions.h"

namespace marrow {

/// A segment from the foot of the point: radius tau(t) = at_foot + slope t over [t1, t2], the point at height h.
template <class X>
struct LineOf {
  X t1, t2, h_squared, at_foot;
  double slope;
};
using Line = LineOf<double>;

/// Where the support of R radii reaches along a line: E = d^2 - R^2 tau^2 = A t^2 + 2 B t + C < 0 and tau > 0, with
/// A = 1 - (R slope)^2. Between two roots for A > 0, else from one on, where the radius grows. For A > 0 both roots are
/// those of the cone's mirror image where the foot lies behind the tip: nothing is reached.
template <class X>
struct Reach {
  std::optional<X> from, to;  ///< roots; nothing where it goes on, or where one is too far off for a double
  X half_rise{};              ///< |dE/dt| / 2 at the roots
  bool is_empty = false;
};

/// The root that is near comes without cancellation, as C / q; what is off of the other by A near 0 does not matter, as
/// E = (t - C/q) (A t - q).
template <class X>
Reach<X> reach_along(const LineOf<X>& line, double R) {
  const double steep = R * line.slope, A = (1 - steep) * (1 + steep);
  const X radius = R * line.at_foot, B = -steep * radius, C = line.h_squared - square(radius);
  const X discriminant = square(radius) - A * line.h_squared;
  Reach<X> reach;
  reach.is_empty = A > 0 && !(value_of(discriminant) > 0 && value_of(radius) > 0);
  if (reach.is_empty) return reach;
  reach.half_rise = sqrt(max(discriminant, X(0.0)));
  const X q = value_of(B) < 0 ? -B + reach.half_rise : -B - reach.half_rise;
  const X first = value_of(q) == 0 ? X(0.0) : C / q;
  const bool has_second = A != 0 && std::isfinite(value_of(q) / A);
  const X second = has_second ? q * (1 / A) : first;
  if (A > 0) {
    const bool is_ordered = has_second ? value_of(first) <= value_of(second) : line.slope > 0;
    if (is_ordered || has_second) reach.from = is_ordered ? first : second;
    if (!is_ordered || has_second) reach.to = is_ordered ? second : first;
    return reach;
  }
  const auto radius_at = [&](const X& t) { return value_of(line.at_foot) + line.slope * value_of(t); };
  (line.slope > 0 ? reach.from : reach.to) = radius_at(first) >= radius_at(second) ? first : second;
  return reach;
}

}  // namespace marrow
