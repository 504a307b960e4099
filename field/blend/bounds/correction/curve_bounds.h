// Bounds of the reference curve of the Cauchy and the compact kernel over intervals.
#pragma once

#include "field/kernel/bounded_curve.h"
#include "field/number/interval.h"

namespace marrow {

/// Of the curve g of BoundedCurve, continued level beyond its top. Under the compact kernel g is concave. Under the
/// Cauchy kernel g' ~ sqrt(v / (1-v)) (e - (e+1) v) rises to one largest value and falls from there on: g is convex,
/// then concave. So the slope of its chords rises, then falls (or does only one of both) along either end, and is least
/// where both ends are at ends of their intervals.
class CurveBounds {
 public:
  explicit CurveBounds(const BoundedCurve&);

  /// An interval of f with the places of its ends.
  struct Span {
    BoundedCurve::Place lo, hi;

    Interval f() const { return {lo.f, hi.f}; }
  };
  Span span(const Interval& f) const { return {curve_.place(f.lo), curve_.place(f.hi)}; }

  Interval at(const Span&) const;
  Interval slope(const Span&) const;
  /// The f <= f* at which the curve has the heights G.
  Interval inverse(const Interval& G) const;
  /// Slopes of the chords between any two places of both intervals.
  Interval chord(const Span& a, const Span& b) const;

  /// Beyond this f the curve is concave, before it convex: 0 under the compact kernel.
  double inflection() const { return inflection_; }
  /// sup of g'(b) / (slope of the chord from a to b), a <= b: slopes of chords are least from 0 or at b itself, and
  /// d ln g / d ln f = (e - v/(1-v)) / (2p) <= e / (2p).
  double largest_ratio() const { return largest_ratio_; }
  const BoundedCurve& curve() const { return curve_; }

 private:
  using Place = BoundedCurve::Place;

  double slope_at(const Place&) const;
  Interval chord_between(const Place& x, const Place& y) const;
  Interval padded(double low, double high) const;

  const BoundedCurve& curve_;
  double inflection_, steepest_, largest_ratio_, slope_error_;
};

}  // namespace marrow
