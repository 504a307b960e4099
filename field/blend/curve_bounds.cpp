#include "field/blend/curve_bounds.h"

#include <algorithm>
#include <cmath>

#include "field/math/elementary.h"

namespace marrow {
namespace {

// Relative errors of g, g', their inverse and their quotients, with a margin of a hundred.
constexpr double relative_error = 1e-12;
// Near the top, where e - v / (1-v) cancels, g' and slopes of chords lose (e+1)^2 roundings of its terms.
constexpr double cancelled = 1e-12;

}  // namespace

CurveBounds::CurveBounds(const BoundedCurve& curve) : curve_(curve) {
  const double e = curve.height_power(), p = curve.field_power(), v_top = e / (e + 1);
  // 2 v^2 - 3 v + e / (e+1) = 0
  const double v = 0.25 * (3 - std::sqrt(9 - 8 * v_top));
  inflection_ = e < 2 * p ? 0 : curve.largest_field() * pow(v, p);
  largest_ratio_ = std::max(1.0, e / (2 * p));
  slope_error_ = cancelled * (e + 1) * curve.top() / curve.top_field();
}

Interval CurveBounds::padded(double low, double high) const {
  return {std::max(0.0, low * (1 - relative_error) - slope_error_), high * (1 + relative_error) + slope_error_};
}

Interval CurveBounds::at(const Interval& f) const {
  return {curve_.at(f.lo) * (1 - relative_error), curve_.at(f.hi) * (1 + relative_error)};
}

double CurveBounds::slope_at(double f) const {
  if (f > 0) return curve_.slope(f);
  return inflection_ > 0 ? 0 : rounding::inf;
}

Interval CurveBounds::slope(const Interval& f) const {
  const double a = slope_at(f.lo), b = slope_at(f.hi);
  const bool holds_steepest = f.lo < inflection_ && inflection_ < f.hi;
  return padded(std::min(a, b), holds_steepest ? slope_at(inflection_) : std::max(a, b));
}

// Newton's iteration is off by some roundings of G; near the top, a double root, that moves the root far more.
Interval CurveBounds::inverse(const Interval& G) const {
  return {curve_.inverse(G.lo * (1 - 1e-13)) * (1 - relative_error),
          std::min(curve_.top_field(), curve_.inverse(G.hi * (1 + 1e-13)) * (1 + relative_error))};
}

// Close to the top the difference of heights is lost; there the curve is concave.
Interval CurveBounds::chord_between(double x, double y) const {
  const double low = std::min(x, y), high = std::max(x, y), top = curve_.top_field();
  if (!(high > 0)) return slope_at(0);
  if (low >= top) return 0;
  if (high >= top && low > 0.999 * high) return {0, slope_at(low)};
  return curve_.chord_slope(high, curve_.at(low), low);
}

Interval CurveBounds::chord(const Interval& a, const Interval& b) const {
  const Interval corners = hull(hull(chord_between(a.lo, b.lo), chord_between(a.lo, b.hi)),
                                hull(chord_between(a.hi, b.lo), chord_between(a.hi, b.hi)));
  Interval s = padded(corners.lo, corners.hi);
  // At a largest slope that is not at an end, the chord has the slope of the curve where it ends.
  const Interval at_a = slope(a), at_b = slope(b), between = slope(hull(a, b));
  double most = between.hi;
  if (a.hi < b.lo) most = std::min(most, ((at(b) - at(a)) / (b - a)).hi);
  for (const Interval& end : {at_a, at_b})
    if (most > end.lo && s.lo < end.hi) s.hi = std::max(s.hi, end.hi);
  return {s.lo, std::min(s.hi, most)};
}

}  // namespace marrow
