#include "field/blend/bounds/correction/curve_bounds.h"

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
  inflection_ = e < 2 * p ? 0 : curve.largest_field() * half_power(v, curve.twice_field_power());
  steepest_ = inflection_ > 0 ? curve.slope(inflection_) : rounding::inf;
  largest_ratio_ = std::max(1.0, e / (2 * p));
  slope_error_ = cancelled * (e + 1) * curve.top() / curve.top_field();
}

Interval CurveBounds::padded(double low, double high) const {
  return {std::max(0.0, low * (1 - relative_error) - slope_error_), high * (1 + relative_error) + slope_error_};
}

Interval CurveBounds::at(const Span& f) const { return {f.lo.g * (1 - relative_error), f.hi.g * (1 + relative_error)}; }

double CurveBounds::slope_at(const Place& place) const {
  if (place.f > 0) return curve_.slope(place);
  return inflection_ > 0 ? 0 : rounding::inf;
}

Interval CurveBounds::slope(const Span& f) const {
  const double a = slope_at(f.lo), b = slope_at(f.hi);
  const bool holds_steepest = f.lo.f < inflection_ && inflection_ < f.hi.f;
  return padded(std::min(a, b), holds_steepest ? steepest_ : std::max(a, b));
}

// Newton's iteration is off by some roundings of G; near the top, a double root, that moves the root far more.
Interval CurveBounds::inverse(const Interval& G) const {
  return {curve_.inverse(G.lo * (1 - 1e-13)) * (1 - relative_error),
          std::min(curve_.top_field(), curve_.inverse(G.hi * (1 + 1e-13)) * (1 + relative_error))};
}

// Close to the top the difference of heights is lost; there the curve is concave.
Interval CurveBounds::chord_between(const Place& x, const Place& y) const {
  const Place &low = x.f < y.f ? x : y, &high = x.f < y.f ? y : x;
  const double top = curve_.top_field();
  if (!(high.f > 0)) return slope_at(high);
  if (low.f >= top) return 0;
  if (high.f >= top && low.f > 0.999 * high.f) return {0, slope_at(low)};
  return curve_.chord_slope(low, high);
}

Interval CurveBounds::chord(const Span& a, const Span& b) const {
  const Interval corners = hull(hull(chord_between(a.lo, b.lo), chord_between(a.lo, b.hi)),
                                hull(chord_between(a.hi, b.lo), chord_between(a.hi, b.hi)));
  Interval s = padded(corners.lo, corners.hi);
  // At a largest slope that is not at an end, the chord has the slope of the curve where it ends.
  const Span all{a.lo.f < b.lo.f ? a.lo : b.lo, a.hi.f < b.hi.f ? b.hi : a.hi};
  double most = slope(all).hi;
  if (a.hi.f < b.lo.f) most = std::min(most, ((at(b) - at(a)) / (b.f() - a.f())).hi);
  for (const Interval& end : {slope(a), slope(b)})
    if (most > end.lo && s.lo < end.hi) s.hi = std::max(s.hi, end.hi);
  return {s.lo, std::min(s.hi, most)};
}

}  // namespace marrow
