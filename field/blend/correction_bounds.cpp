#include "field/blend/correction_bounds.h"

#include <algorithm>
#include <cmath>

#include "field/blend/bounded_partials.h"
#include "field/blend/projection_angles.h"
#include "field/kernel/inverse_family.h"
#include "field/math/box3.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;

// Slope of the chord of the convex curve g between two of its points; isotone in both.
Interval chord_slope(const ReferenceCurve& curve, const Interval& a, const Interval& b) {
  const auto slope = [&](double x, double y) {
    if (std::fabs(x - y) < 1e-4 * std::max(x, y)) return curve.slope(0.5 * (x + y));
    return (curve.at(x) - curve.at(y)) / (x - y);
  };
  // Near the diagonal the slope in the middle is off by (1e-4)^2 / 24 g'''/g' < 1e-8, farther the difference loses
  // 1e-11.
  return {slope(a.lo, b.lo) * (1 - 1e-8), slope(a.hi, b.hi) * (1 + 1e-8)};
}

// C is isotone and its clamp makes it no steeper than the curve: dC/df <= 1, dC/dG <= 1/g'(C).   [tracing 3.3]
PartialBounds coarse_partials(const ReferenceCurve& curve, const Interval& value) {
  return {{0, 1}, {0, value.lo > 0 ? rounding::up(1 / curve.slope(value.lo), 8) : inf}};
}

// The partial derivatives of the projection onto the chord. The share psi falls with the angle and rises with the slope
// of the chord. Where C is cut at 0, that by the angle is 0.   [field-maths 4.5]
PartialBounds chord_partials(const ReferenceCurve& curve, const Angles& angle, const Interval& f, const Interval& x_H) {
  const auto& [sine, cosine] = angle;
  const Interval s = chord_slope(curve, f, x_H), den = s * cosine + sine;
  const auto share = [](double slope, double c, double w) { return slope * c / (slope * c + w); };
  const Interval psi{rounding::down(share(s.lo, cosine.lo, sine.hi), 4),
                     rounding::up(share(s.hi, cosine.hi, sine.lo), 4)};
  const Interval ps = cosine * sine / square(den);
  const auto slope = [&](const Interval& x) { return Interval{curve.slope(x.lo), curve.slope(x.hi)}; };
  const Interval df = Interval(1) - psi - ps * (slope(f) - s);
  const Interval dx = psi - ps * (s - slope(x_H));
  return {{std::max(0.0, df.lo), df.hi},
          Interval{std::max(0.0, dx.lo), dx.hi} / slope(x_H),
          hull(s * (f - x_H) / square(den), Interval(0))};
}

// The root of g(x) cos + x sin = G cos + f sin moves by sin / (g' cos + sin) with f, by cos / (g' cos + sin) with G,
// and with the angle by ((f - x) cos + (g - G) sin) / (g' cos + sin).
PartialBounds exact_partials(const ReferenceCurve& curve, const Angles& angle, const Interval& value, const Interval& f,
                             const Interval& G) {
  const Interval slope{curve.slope(value.lo) * (1 - 1e-9), curve.slope(value.hi) * (1 + 1e-9)};
  const Interval at{curve.at(value.lo) * (1 - 1e-12), curve.at(value.hi) * (1 + 1e-12)};
  const Interval den = slope * angle.cosine + angle.sine;
  return {angle.sine / den, angle.cosine / den, ((f - value) * angle.cosine + (at - G) * angle.sine) / den};
}

// Behind the critical point the corrected value is that of D: only where c = G r^n / (2 (n-1)) < 1 / sqrt(n+1).
bool may_be_behind_critical_point(const Correction& c, const Interval& f, const Interval& G) {
  if (!c.cavity() || !(f.hi > 0)) return c.cavity();
  const int n = c.degree();
  const double r = pow(2 / f.hi, 1.0 / (n - 1));
  return G.lo * integer_power(r, n) / (2 * (n - 1)) < (1 + 1e-9) / std::sqrt(n + 1.0);
}

}  // namespace

PartialBounds partial_bounds(const BlendField& blend, const Correction& c, const Interval& alpha, const Interval& value,
                             const Interval& f, const Interval& G) {
  if (c.is_sum()) return {{1, 1}, {0, 0}, {0, 0}};
  if (c.bounded()) return bounded_partials(c, alpha, value, f, G);
  const ReferenceCurve curve(blend.degree);
  if (!(f.lo > 0 && G.lo > 0) || may_be_behind_critical_point(c, f, G))
    return c.cavity() ? coarse_partials(curve, value) : PartialBounds{Interval::everything(), Interval::everything()};
  const Angles angle = angles_of(alpha);
  if (c.projection() == Projection::Exact) return exact_partials(curve, angle, value, f, G);
  const Interval x_H{curve.inverse(G.lo) * (1 - 1e-12), curve.inverse(G.hi) * (1 + 1e-12)};
  return chord_partials(curve, angle, f, x_H);
}

// For alpha >= 0 C is isotone in both.   [tracing 3.3]
// Below 0, where the guard cannot act, it is isotone in G; along f its largest value is at an end, its least at an end
// or on the crest of the curves M_d. Where the guard may act, C lies between 0 and 2 x_H.   [tracing 3.3;
// field-maths 4.4]
Interval correction_bounds(const Correction& c, const Interval& f, const Interval& G) {
  if (c.alpha() >= 0) return {c.value(f.lo, G.lo) * (1 - 1e-12), c.value(f.hi, G.hi) * (1 + 1e-12)};
  const int n = c.degree();
  const ReferenceCurve curve(n);
  const double x_least = curve.inverse(G.lo), tangent = -tan(c.alpha());
  const bool may_be_guarded = chord_slope(curve, Interval(f.lo), Interval(x_least)).lo < 2 * tangent * (1 + 1e-9);
  if (may_be_guarded || !(f.lo > 0)) return {0, 2 * curve.inverse(G.hi) * (1 + 1e-12)};
  const double crest_r = pow(2 * (n - 1) / (std::sqrt(n + 1.0) * G.lo), 1.0 / n);
  const double crest = std::clamp(2 / integer_power(crest_r, n - 1), f.lo, f.hi);
  const double least = std::min({c.value(f.lo, G.lo), c.value(f.hi, G.lo), c.value(crest, G.lo)});
  const double most = std::max(c.value(f.lo, G.hi), c.value(f.hi, G.hi));
  return {least * (1 - 1e-9), most * (1 + 1e-9)};
}

// In the cavity branch what is projected moves with the angle while the projection turns, and C may fall, then rise.
// The projection is isotone in both of its place's numbers and monotone in the angle: it is bounded over all places
// between those of the two ends.
Interval correction_bounds_between(const BoundedCorrection& least, const BoundedCorrection& most, const Interval& f,
                                   const Interval& G) {
  using Place = BoundedCorrection::Place;
  const Place low = {least.projected_from(f.lo, G.lo).f, most.projected_from(f.lo, G.lo).G};
  const Place high = {most.projected_from(f.hi, G.hi).f, least.projected_from(f.hi, G.hi).G};
  // C(0, G) = 0, though the projection is not
  return {std::min({least.projected(low), most.projected(low), least.value(f.lo, G.lo)}) * (1 - 1e-12),
          std::max(least.projected(high), most.projected(high)) * (1 + 1e-12)};
}

}  // namespace marrow
