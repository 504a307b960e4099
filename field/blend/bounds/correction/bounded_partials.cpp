#include "field/blend/bounds/correction/bounded_partials.h"

#include <algorithm>
#include <cmath>

#include "field/blend/bounds/correction/projection_partials.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

// More than all roundings of a formula without cancellation.
constexpr double error = 1e-11;
// Below, C = f; as in bounded_correction.cpp.
constexpr double smallest_field = 1e-60;

Interval padded(double low, double high) { return {low * (1 - error), high * (1 + error)}; }

// k = (w / w_1)^(-sign p) of one unit skeleton.
struct Powers {
  double n, sign, p, w_1;
  int degree, twice_p;

  explicit Powers(const BoundedCorrection& c)
      : n(c.kernel().degree),
        sign(c.kernel().family == KernelFamily::Cauchy ? 1 : -1),
        p(c.curve().field_power()),
        w_1(c.unit_w()),
        degree(c.kernel().degree),
        twice_p(c.curve().twice_field_power()) {}

  // Where B = n h^2 on M, which holds all places behind critical points:  f^2 = (n + sign) G^2 w / (4 p^2). With f =
  // 2 u^(2p), w = w_1 u^(-2 sign) that is u^n = G sqrt((n + sign) w_1) / (4p).
  double crest_field(double G) const { return 2 * integer_power(root(crest() * G, degree), twice_p); }
  double crest_gradient(double f) const { return integer_power(root(f / 2, twice_p), degree) / crest(); }
  double crest() const { return std::sqrt((n + sign) * w_1) / (4 * p); }
  Interval field(const Interval& w) const {
    const auto at = [&](double x) { return 2 * half_power(sign > 0 ? w_1 / x : x / w_1, twice_p); };
    return sign > 0 ? padded(at(w.hi), at(w.lo)) : padded(at(w.lo), at(w.hi));
  }
};

// The places behind critical points, for a range of angles.
class Behind {
 public:
  Behind(const BoundedCorrection& least, const BoundedCorrection& most, const Powers& powers, const Interval& f,
         const Interval& G);
  PartialBounds partials(const ProjectionPartials&, const Interval& value) const;

 private:
  struct Critical {
    Interval h, w, u;
  };
  Critical critical(const BoundedCorrection& least, const BoundedCorrection& most) const;

  Powers of_;
  Interval f_, G_;
  Interval B_, u_;
  Interval dG_over_gain_;
  Critical D_;
};

// In this branch, which is open towards larger f and smaller G, f and G both move B one way; to the crest from there.
Behind::Behind(const BoundedCorrection& least, const BoundedCorrection& most, const Powers& powers, const Interval& f,
               const Interval& G)
    : of_(powers),
      f_{std::min(f.hi, std::max(f.lo, powers.crest_field(G.lo) * (1 - error))), f.hi},
      G_{G.lo, std::max(G.lo, std::min(G.hi, powers.crest_gradient(f.hi) * (1 + error)))} {
  const auto far = least.pair_at(f_.lo, G_.lo), near = least.pair_at(f_.hi, G_.hi);
  B_ = padded(std::min(far.B, near.B), std::max(far.B, near.B));
  const Interval w{std::min(far.w, near.w), std::max(far.w, near.w)};
  const Interval psi = padded(of_.p * f_.lo, of_.p * f_.hi) / w;
  dG_over_gain_ = G_ / (2 * square(psi) * B_);
  u_ = clamped(square(G_ / (2 * psi)) / B_, {0, 1 / of_.n});
  D_ = critical(least, most);
}

// h rises with B and falls with alpha, h^2 / B falls with both, w rises with B (and, as h, falls or rises with alpha).
Behind::Critical Behind::critical(const BoundedCorrection& least, const BoundedCorrection& most) const {
  const auto h = [&](const BoundedCorrection& c, double B) { return c.critical_height(B); };
  const double low = h(most, B_.lo), high = h(least, B_.hi), wide = h(least, B_.lo), narrow = h(most, B_.hi);
  const double of_low = of_.sign > 0 ? low : wide, of_high = of_.sign > 0 ? high : narrow;
  return {padded(low, high), padded(B_.lo + of_.sign * square(of_low), B_.hi + of_.sign * square(of_high)),
          padded(square(narrow) / B_.hi, square(wide) / B_.lo)};
}

PartialBounds Behind::partials(const ProjectionPartials& projection, const Interval& value) const {
  const double n = of_.n, sign = of_.sign, p = of_.p;
  const Interval &h = D_.h, &u = D_.u;
  const Interval D_f = of_.field(D_.w), D_G = 2 * p * D_f * h / D_.w;
  const PartialBounds at_D = projection.at(value, D_f, D_G);
  const Interval open = 1 + sign * u, den = 1 + (n + 3 * sign) * u - sign * n * square(u);
  // E and L are monotone; E rises with u
  const auto E_at = [&](double x) { return (n + sign) * x / (1 + (n + 3 * sign) * x - sign * n * (x * x)); };
  const Interval E = padded(E_at(u.lo), E_at(u.hi)), L = (1 + 2 * sign * u * E) / open;
  const Interval by_f = p * D_f * at_D.df, by_G = D_G * at_D.dG;
  const Interval gain = L * by_f + ((p + sign) * L - sign * E) * by_G;
  // h falls with the angle by h A, h A = ((1 - n u)^2 + u B (1 + sign u)^2) / den
  const Interval flat = 1 - n * u, hA = (square(flat) + u * B_ * square(open)) / den;
  const Interval along = hA / open * (2 * h / B_ * by_f - flat * (2 * p * D_f / D_.w * at_D.dG));
  return {gain * (1 - n * u_) / (p * f_), gain * dG_over_gain_, at_D.dalpha + along};
}

}  // namespace

PartialBounds bounded_partials(const Correction& c, const Interval& alpha, const Interval& value, const Interval& all_f,
                               const Interval& all_G) {
  const BoundedCorrection& least = *c.bounded();
  const Interval f = padded(all_f.lo, all_f.hi), G = padded(all_G.lo, all_G.hi);
  const CurveBounds curve(least.curve());
  const ProjectionPartials projection(curve, c.projection(), angles_of(alpha));
  const PartialBounds same{1, 0, 0};
  if (!(f.hi > smallest_field)) return same;
  if (f.lo <= smallest_field) {
    const PartialBounds any = projection.at(value, f, G);
    return c.cavity() ? PartialBounds{{0, rounding::inf}, {0, rounding::inf}} : hull(any, same);
  }
  if (!c.cavity() || !least.in_cavity_branch(f.hi, G.lo)) return projection.at(value, f, G);
  const BoundedCorrection most =
      alpha.lo == alpha.hi ? least : BoundedCorrection(least.kernel(), alpha.hi, true, c.projection());
  const PartialBounds behind = Behind(least, most, Powers(least), f, G).partials(projection, value);
  return most.in_cavity_branch(f.lo, G.hi) ? behind : hull(behind, projection.at(value, f, G));
}

}  // namespace marrow
