#include "field/blend/bounds/correction/projection_partials.h"

#include <algorithm>
#include <cmath>

namespace marrow {
namespace {

using rounding::inf;
using rounding::product;

// More than all roundings of a formula without cancellation.
constexpr double error = 1e-11;

Interval padded(double low, double high) { return {low * (1 - error), high * (1 + error)}; }
// a / b of numbers that are not negative; of two infinite or vanishing ones, what bounds from above.
double at_most(double a, double b) { return b == 0 || a == inf ? inf : a / b; }
double at_least(double a, double b) { return a == 0 || b == inf ? 0 : a / b; }

// a / (a + b), and what is left; where both vanish the first counts alone.
double share(double a, double b) { return a == inf || b == 0 ? 1 : a / (a + b); }
double rest(double a, double b) { return a == inf || b == 0 ? 0 : b / (a + b); }

// g'(f) over the slope s of a chord, s over g'(x_H).   Where the curve is concave g'(f) <= s <= g'(x_H).
struct Ratios {
  Interval f_to_chord, chord_to_x;
};
Ratios ratios(const CurveBounds& curve, const Interval& s, const CurveBounds::Span& f, const CurveBounds::Span& x) {
  const Interval at_f = curve.slope(f), at_x = curve.slope(x);
  const double least = f.hi.f <= curve.inflection() ? 1 : 0, most = x.lo.f >= curve.inflection() ? 1 : inf;
  const auto within = [&](double low, double high, double top) {
    return Interval{std::clamp(low * (1 - error), least, top), std::clamp(high * (1 + error), least, top)};
  };
  return {within(at_least(at_f.lo, s.hi), at_most(at_f.hi, s.lo), std::min(most, curve.largest_ratio())),
          within(at_least(s.lo, at_x.hi), at_most(s.hi, at_x.lo), most)};
}

}  // namespace

ProjectionPartials::ProjectionPartials(const CurveBounds& curve, Projection projection, const Angles& angle)
    : curve_(curve), projection_(projection), angle_(angle) {}

PartialBounds ProjectionPartials::at(const Interval& value, const Interval& f, const Interval& G) const {
  const CurveBounds::Span places = curve_.span(f);
  const Interval g = curve_.at(places);
  if (projection_ == Projection::Exact || !(G.lo < g.hi)) return on_line(value, f, G);
  const PartialBounds below = on_chord(places, {G.lo, std::min(G.hi, g.hi)});
  return G.hi < g.lo ? below : hull(below, on_line(value, f, {std::max(G.lo, g.lo), G.hi}));
}

// With the slope s of the chord, r = g'(f) / s, t = s / g'(x_H) and psi = s cos / (s cos + sin):
//   dC/df = (1 - psi) (1 + psi (1 - r)), which falls with psi and with r, as r < 2 (largest_ratio() is 3/2 at most);
//   dC/dG = (1 + psi (t - 1)) / (s + tan), linear in psi;   dC/dalpha = (g(f) - G) / (s cos + sin)^2.
PartialBounds ProjectionPartials::on_chord(const CurveBounds::Span& all, const Interval& G) const {
  const CurveBounds::Span x = curve_.span(curve_.inverse(G));
  const auto behind = [&](const BoundedCurve::Place& place) { return place.f < x.lo.f ? x.lo : place; };
  const CurveBounds::Span f{behind(all.lo), behind(all.hi)};
  const Interval s = curve_.chord(x, f);
  const auto& [sine, cosine] = angle_;
  const auto [r, t] = ratios(curve_, s, f, x);
  const double least = product(s.lo, cosine.lo), most = product(s.hi, cosine.hi);
  const Interval psi{share(least, sine.hi), share(most, sine.lo)};
  const auto grown = [](double p, double by) { return 1 + product(p, by - 1); };
  const Interval df{rest(most, sine.lo) * (1 + psi.hi * (1 - r.hi)), rest(least, sine.hi) * (1 + psi.lo * (1 - r.lo))};
  const double dG_low =
      at_least(cosine.lo * std::min(grown(psi.lo, t.lo), grown(psi.hi, t.lo)), product(s.hi, cosine.lo) + sine.hi);
  const double dG_high = at_most(product(cosine.hi, std::max(grown(psi.lo, t.hi), grown(psi.hi, t.hi))),
                                 product(s.lo, cosine.hi) + sine.lo);
  const Interval above = curve_.at(f) - G, den{least + sine.lo, most + sine.hi};
  const Interval dalpha = Interval{std::max(0.0, above.lo), std::max(0.0, above.hi)} / square(den);
  return {padded(std::max(0.0, df.lo), df.hi), padded(dG_low, dG_high), dalpha};
}

// C = min(the place on the line, max(f, f*)): with A = G - g* and B = f* - f held back where A >= 0 and A cos >= B sin.
PartialBounds ProjectionPartials::on_line(const Interval& value, const Interval& f, const Interval& G) const {
  const auto& [sine, cosine] = angle_;
  const double top = curve_.curve().top_field(), height = curve_.curve().top(), slack = error * (top + height);
  const double A = G.hi - height + slack, B = top - f.hi - slack;
  const bool is_free = A < 0 || (B > 0 && A * cosine.hi < B * sine.lo);
  if (is_free) return on_curve(value, f, G);
  // beyond the top C = f, but f* at alpha = 0
  const bool is_beyond = f.hi > top - slack, is_level = !(f.lo > top + slack) || sine.lo == 0;
  const PartialBounds held_back{{is_level ? 0.0 : 1.0, is_beyond && sine.hi > 0 ? 1.0 : 0.0},
                                0,
                                {0, is_beyond && sine.lo == 0 && sine.hi > 0 ? inf : 0}};
  const double least_A = G.lo - height - slack, most_B = top - f.lo + slack;
  const bool is_held_back = least_A > 0 && least_A * cosine.lo > most_B * sine.hi;
  return is_held_back ? held_back : hull(on_curve(value, f, G), held_back);
}

// The root x of g(x) cos + x sin = G cos + f sin.
PartialBounds ProjectionPartials::on_curve(const Interval& value, const Interval& f, const Interval& G) const {
  const auto& [sine, cosine] = angle_;
  const CurveBounds::Span places = curve_.span(value);
  const Interval slope = curve_.slope(places);
  const Interval df{at_least(sine.lo, product(slope.hi, cosine.hi) + sine.lo),
                    sine.hi == 0 ? 0 : rest(product(slope.lo, cosine.lo), sine.hi)};
  const Interval dG{at_least(cosine.lo, product(slope.hi, cosine.lo) + sine.hi),
                    at_most(cosine.hi, product(slope.lo, cosine.hi) + sine.lo)};
  const Interval den{product(slope.lo, cosine.lo) + sine.lo, product(slope.hi, cosine.hi) + sine.hi};
  return {padded(df.lo, df.hi), padded(dG.lo, dG.hi), ((f - value) * cosine + (curve_.at(places) - G) * sine) / den};
}

}  // namespace marrow
