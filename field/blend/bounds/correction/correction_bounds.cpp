#include "field/blend/bounds/correction/correction_bounds.h"

#include <algorithm>
#include <cmath>

#include "field/blend/bounds/correction/bounded_partials.h"
#include "field/blend/bounds/correction/chord_bounds.h"
#include "field/blend/bounds/correction/partials_below_zero.h"
#include "field/blend/bounds/correction/projection_angles.h"
#include "field/math/box3.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;

// C is isotone and its clamp makes it no steeper than the curve: dC/df <= 1, dC/dG <= 1/g'(C).   [trace/README.md]
PartialBounds coarse_partials(const ReferenceCurve& curve, const Interval& value) {
  return {{0, 1}, {0, value.lo > 0 ? rounding::up(1 / curve.slope(value.lo), 8) : inf}};
}

// The partial derivatives of the projection onto the chord. The share psi falls with the angle and rises with the slope
// of the chord. Where C is cut at 0, that by the angle is 0.
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
  if (alpha.lo < 0) {
    const PartialBounds below = partials_below_zero(c, {alpha.lo, std::min(alpha.hi, 0.0)}, value, f, G);
    if (!(alpha.hi > 0)) return below;
    return hull(below, partial_bounds(blend, Correction(c.degree(), 0, c.cavity(), c.projection()), {0, alpha.hi},
                                      value, f, G));
  }
  const ReferenceCurve curve(blend.degree);
  if (!(f.lo > 0 && G.lo > 0) || may_be_behind_critical_point(c, f, G))
    return c.cavity() ? coarse_partials(curve, value) : PartialBounds{Interval::everything(), Interval::everything()};
  const Angles angle = angles_of(alpha);
  if (c.projection() == Projection::Exact) return exact_partials(curve, angle, value, f, G);
  return chord_partials(curve, angle, f, x_H_of(curve, G));
}

// For alpha >= 0 C is isotone in both.   [trace/README.md]
// Below 0, guarded or not, it is isotone in G. Along f the projection falls; behind the critical point C falls with a,
// which along f is largest on the crest of the curves M_d: so C is largest at an end, or as f goes to 0, and least at
// an end or on the crest.   [partials_below_zero.h]
Interval correction_bounds(const Correction& c, const Interval& f, const Interval& G) {
  if (c.alpha() >= 0) return {c.value(f.lo, G.lo) * (1 - 1e-12), c.value(f.hi, G.hi) * (1 + 1e-12)};
  const int n = c.degree();
  const auto bounds = [](double least, double most) {
    constexpr double lost = 1e-15;  // of C, where powers of distances cancel (f < 1e-12)
    return Interval{std::max(0.0, least * (1 - 1e-9) - lost), most * (1 + 1e-9) + lost};
  };
  if (!(f.lo > 0)) return bounds(0, std::max(c.value(f.hi, G.hi), 2 * ReferenceCurve(n).inverse(G.hi)));
  const double crest_r = pow(2 * (n - 1) / (std::sqrt(n + 1.0) * G.lo), 1.0 / n);
  const double crest = std::clamp(2 / integer_power(crest_r, n - 1), f.lo, f.hi);
  return bounds(std::min({c.value(f.lo, G.lo), c.value(f.hi, G.lo), c.value(crest, G.lo)}),
                std::max(c.value(f.lo, G.hi), c.value(f.hi, G.hi)));
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
