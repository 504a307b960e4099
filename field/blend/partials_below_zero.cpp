#include "field/blend/partials_below_zero.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "field/blend/chord_bounds.h"

namespace marrow {
namespace {

// Powers of distances may leave the range of double beyond.
constexpr double smallest_field = 1e-40, largest_field = 1e40;
constexpr double relative_error = 1e-9;  // of what is found by roots of the cubic, with a margin of a hundred
const PartialBounds unknown{Interval::everything(), Interval::everything()};

Interval padded(double low, double high) { return {low * (1 - relative_error), high * (1 + relative_error)}; }

PartialBounds hull_of(const PartialBounds& a, const PartialBounds& b) { return {hull(a.df, b.df), hull(a.dG, b.dG)}; }

// Of the projection onto the chord, in front of the critical point.
PartialBounds of_projection(const Correction& correction, const ReferenceCurve& curve, const Interval& f,
                            const Interval& G) {
  const double t = -sin(correction.alpha()), c = cos(correction.alpha());
  const Interval x_H = x_H_of(curve, G), slope_at_H = slope_of(curve, x_H), w = c * chord_slope(curve, f, x_H);
  const PartialBounds guarded{-1, Interval(2) / slope_at_H};
  if (w.hi < 2 * t) return guarded;
  const Interval free{std::max(w.lo, rounding::down(2 * t, 2)), w.hi}, den = square(free - Interval(t));
  const Interval df = -t * (2 * free - Interval(t) - c * slope_of(curve, f)) / den;
  const Interval dG = (square(free) / slope_at_H - Interval(c * t)) / den;
  const PartialBounds not_guarded{{std::min(0.0, df.lo), std::min(0.0, df.hi)}, {std::max(0.0, dG.lo), dG.hi}};
  return w.lo > 2 * t ? not_guarded : hull_of(guarded, not_guarded);
}

// The critical points D of the curves M_d of an interval of a: eta rises with a, also where M_d is nowhere so steep.
struct CriticalPoints {
  Interval a, eta, eta_slope;
};

std::optional<CriticalPoints> critical_points(const Correction& correction, const Interval& a) {
  const Correction::CriticalPoint first = correction.critical_point(a.lo), last = correction.critical_point(a.hi);
  const Interval eta = padded(first.eta, last.eta), z = Interval(1) / eta;
  const double tangent = tan(correction.alpha());
  const Interval k = a * tangent, n = correction.degree();
  if (first.is_steepest != last.is_steepest) return {};  // there eta has a vertical tangent
  if (first.is_steepest) {
    const Interval half_width = sqrt((square(k) * (1.0 / 3) + n) * (1.0 / 3));
    const Interval slope = -square(eta) * (tangent * (Interval(1.0 / 3) + k / (9 * half_width)));
    return CriticalPoints{a, eta, padded(std::max(0.0, slope.lo), slope.hi)};
  }
  const Interval cubic_slope = (3 * z - 2 * k) * z - n;
  if (!(cubic_slope.lo > 0)) return {};
  return CriticalPoints{a, eta, -tangent * (square(z) + Interval(1)) / (cubic_slope * square(z))};
}

// dC/da, of C at D.
Interval slope_along_a(const Correction& correction, const ReferenceCurve& curve, const CriticalPoints& points) {
  const int n = correction.degree();
  const auto& [a, eta, eta_slope] = points;
  const Interval r_D = a * sqrt(Interval(1) + square(eta)), power = Interval(1) / integer_power(r_D, n - 1);
  const Interval D_f = 2 * power, D_G = (2.0 * (n - 1)) * power * (a * eta) / square(r_D);
  const Interval r_share = Interval(1) / a + square(a) * eta * eta_slope / square(r_D);  // d ln r_D / da
  const Interval D_f_slope = -(n - 1.0) * D_f * r_share;
  const Interval D_G_slope = D_G * (Interval(1) / a + eta_slope / eta - (n + 1.0) * r_share);
  const PartialBounds at_D = of_projection(correction, curve, D_f, D_G);
  const Interval slope = at_D.df * D_f_slope + at_D.dG * D_G_slope;
  return {std::min(0.0, slope.lo), std::min(0.0, slope.hi)};
}

}  // namespace

// A is at r = (2/f)^(1/(n-1)) from two skeletons 2 a apart, a^2 = r^2 (1 - c^2), c = G r^n / (2 (n-1)), and behind D
// where eta = c / sqrt(1 - c^2) is less than that of D.
PartialBounds partials_below_zero(const Correction& correction, const Interval& value, const Interval& f,
                                  const Interval& G) {
  if (!(f.lo > smallest_field && f.hi < largest_field && G.hi < largest_field)) return unknown;
  const int n = correction.degree();
  const ReferenceCurve curve(n);
  const auto with_cut = [&](const PartialBounds& b) { return value.lo > 0 ? b : hull_of(b, {0, 0}); };
  const auto in_front = [&] { return G.lo > 0 ? of_projection(correction, curve, f, G) : unknown; };
  if (!correction.cavity()) return with_cut(in_front());

  const Interval r = padded(1 / curve.inverse_distance(f.hi / 2), 1 / curve.inverse_distance(f.lo / 2));
  const Interval c = G * integer_power(r, n) * (1.0 / (2 * (n - 1)));
  const double highest = correction.critical_point(r.hi).eta * (1 + relative_error);
  const double most = highest / std::sqrt(1 + highest * highest);
  if (c.lo > most) return with_cut(in_front());
  const Interval behind{c.lo, std::min(c.hi, most)}, flatness = sqrt(Interval(1) - square(behind));
  const auto points = critical_points(correction, r * flatness);
  if (!points) return unknown;
  const Interval along_a = slope_along_a(correction, curve, *points), a = points->a;
  const Interval a_by_f = square(r) * ((n + 1.0) * square(behind) - Interval(1)) / ((n - 1.0) * f * a);
  const Interval minus_a_by_G = integer_power(r, n + 2) * behind * (1.0 / (2 * (n - 1))) / a;
  const PartialBounds at_D{along_a * a_by_f, -along_a * minus_a_by_G};
  const bool is_behind = c.hi < 1 && (behind / flatness).hi < points->eta.lo;
  return with_cut(is_behind ? at_D : hull_of(at_D, in_front()));
}

}  // namespace marrow
