#include "field/blend/bounds/correction/partials_below_zero.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "field/blend/bounds/correction/chord_bounds.h"

namespace marrow {
namespace {

// Powers of distances may leave the range of double beyond.
constexpr double smallest_field = 1e-40, largest_field = 1e40;
constexpr double relative_error = 1e-9;  // of what is found by roots of the cubic, with a margin of a hundred
const PartialBounds unknown{Interval::everything(), Interval::everything()};

Interval padded(double low, double high) { return {low * (1 - relative_error), high * (1 + relative_error)}; }

// tan |alpha| of angles from -1 to 0.
Interval steepness_of(const Interval& alpha) {
  return {std::max(0.0, rounding::down(-tan(alpha.hi), 2)), rounding::up(-tan(alpha.lo), 2)};
}

// Of the projection onto the chord, in front of the critical point, k = tan |alpha|.
PartialBounds of_projection(const ReferenceCurve& curve, const Interval& k, const Interval& f, const Interval& G) {
  const Interval x_H = x_H_of(curve, G), slope_at_H = slope_of(curve, x_H), all = chord_slope(curve, f, x_H);
  const PartialBounds guarded{-1, Interval(2) / slope_at_H, 0};
  if (all.hi < 2 * k.lo) return guarded;
  // s - k is k, and s / 2, at least
  const Interval s{std::max(all.lo, 2 * k.lo), all.hi};
  const Interval less = s - k, den = square(Interval(std::max({less.lo, 0.5 * s.lo, k.lo}), less.hi));
  const Interval df = -k * (2 * s - k - slope_of(curve, f)) / den, dG = (square(s) / slope_at_H - k) / den;
  const Interval dalpha = s * (f - x_H) * (Interval(1) + square(k)) / den;
  const PartialBounds free{{std::min(0.0, df.lo), std::min(0.0, df.hi)}, {std::max(0.0, dG.lo), dG.hi}, dalpha};
  return all.lo > 2 * k.hi ? free : hull(guarded, free);
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
  const PartialBounds at_D = of_projection(curve, steepness_of(correction.alpha()), D_f, D_G);
  const Interval slope = at_D.df * D_f_slope + at_D.dG * D_G_slope;
  return {std::min(0.0, slope.lo), std::min(0.0, slope.hi)};
}

}  // namespace

// A is at r = (2/f)^(1/(n-1)) from two skeletons 2 a apart, a^2 = r^2 (1 - c^2), c = G r^n / (2 (n-1)), and behind D
// where eta = c / sqrt(1 - c^2) is less than that of D, which is largest for the least angle.
PartialBounds partials_below_zero(const Correction& least, const Interval& alpha, const Interval& value,
                                  const Interval& f, const Interval& G) {
  if (!(f.lo > smallest_field && f.hi < largest_field && G.hi < largest_field)) return unknown;
  const int n = least.degree();
  const ReferenceCurve curve(n);
  const auto with_cut = [&](const PartialBounds& b) { return value.lo > 0 ? b : hull(b, {0, 0, 0}); };
  const auto in_front = [&] { return G.lo > 0 ? of_projection(curve, steepness_of(alpha), f, G) : unknown; };
  if (!least.cavity()) return with_cut(in_front());

  const Interval r = padded(1 / curve.inverse_distance(f.hi / 2), 1 / curve.inverse_distance(f.lo / 2));
  const Interval c = G * integer_power(r, n) * (1.0 / (2 * (n - 1)));
  const double highest = least.critical_point(r.hi).eta * (1 + relative_error);
  const double most = highest / std::sqrt(1 + highest * highest);
  if (c.lo > most) return with_cut(in_front());
  if (alpha.lo < alpha.hi) return unknown;
  const Interval behind{c.lo, std::min(c.hi, most)}, flatness = sqrt(Interval(1) - square(behind));
  const auto points = critical_points(least, r * flatness);
  if (!points) return unknown;
  const Interval along_a = slope_along_a(least, curve, *points), a = points->a;
  const Interval a_by_f = square(r) * ((n + 1.0) * square(behind) - Interval(1)) / ((n - 1.0) * f * a);
  const Interval minus_a_by_G = integer_power(r, n + 2) * behind * (1.0 / (2 * (n - 1))) / a;
  const PartialBounds at_D{along_a * a_by_f, -along_a * minus_a_by_G};
  const bool is_behind = c.hi < 1 && (behind / flatness).hi < points->eta.lo;
  return with_cut(is_behind ? at_D : hull(at_D, in_front()));
}

}  // namespace marrow
