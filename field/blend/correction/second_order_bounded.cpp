// The formulas of bounded_correction.cpp and bounded_curve.cpp, in forms that can be differentiated twice.
#include "field/blend/correction/second_order_bounded.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/elementary.h"
#include "field/number/quotients.h"
#include "field/skeleton/implicit_root.h"

namespace marrow {
namespace {

using X = HessianJet;

// Below, the compact kernel counts as outside.
constexpr double smallest_field = 1e-60, smallest_gradient = 1e-150;

// f = f_max v^p, g = g_0 sqrt(1 - v) v^(e/2).
struct Curve {
  const BoundedCurve& of;
  double p = of.field_power(), e = of.height_power();

  double parameter(double f) const { return std::min(1.0, pow(f / of.largest_field(), 1 / p)); }
  X parameter(const X& f) const { return pow(f * (1 / of.largest_field()), 1 / p); }
  X field(const X& v) const { return of.largest_field() * pow(v, p); }
  X height(const X& v) const { return of.height_scale() * sqrt(1.0 - v) * pow(v, e / 2); }

  // v_H with g(v_H) = G, from e ln v + ln(1 - v) = ln(G^2 / g_0^2).
  X parameter_at(const X& G_squared) const {
    const double root = parameter(of.inverse(std::sqrt(G_squared.value)));
    const X target = log(G_squared * (1 / (of.height_scale() * of.height_scale())));
    return implicit_root(root, e / root - 1 / (1 - root),
                         [&](const X& v) { return e * log(v) + log(1.0 - v) - target; });
  }
  // g(x) c + x s = height
  X on_line(const X& c, const X& s, const X& height_of_line) const {
    if (!(height_of_line.value > 0)) return X(0.0);
    if (!(height_of_line.value < of.top() * c.value + of.top_field() * s.value))
      return s.value > 0 ? max(X(of.top_field()), (height_of_line - of.top() * c) / s) : X(of.top_field());
    const double x = of.on_line(c.value, s.value, height_of_line.value), v = parameter(x);
    const double g = of.at(x), slope = (c.value * g * (e - v / (1 - v)) / 2 + s.value * p * x) / v;
    return field(implicit_root(v, slope, [&](const X& w) { return height(w) * c + field(w) * s - height_of_line; }));
  }
};

struct Chord {
  X x_H, slope;
};

// With L = ln(v_H / v_f): the quotient of g(f) - G and f - x_H, with L taken out of both.
Chord chord_to(const Curve& curve, const X& f, const X& G_squared) {
  const bool is_level = !(f.value < curve.of.top_field());
  const bool is_flat = !(G_squared.value > smallest_gradient * smallest_gradient);
  const X v_H = is_flat ? X(0.0) : curve.parameter_at(G_squared), x_H = is_flat ? X(0.0) : curve.field(v_H);
  if (is_level) return {x_H, (curve.of.top() - sqrt(G_squared)) / (f - x_H)};
  const X v = curve.parameter(f), steepness = curve.height(v) / f;
  if (is_flat) return {x_H, steepness};
  const X L = log(v_H / v), odds = v / (1.0 - v), growth = exp_quotient(L);
  const X U = curve.e / 2 - 0.5 * odds * growth * log_quotient(-odds * L * growth);
  return {x_H, steepness * (U * exp_quotient(L * U) / (curve.p * exp_quotient(curve.p * L)))};
}

X projected(const Curve& curve, Projection projection, const X& f, const X& G_squared, const X& sine, const X& cosine) {
  if (projection == Projection::Exact || !(std::sqrt(G_squared.value) < curve.of.at(f.value)))
    return min(curve.on_line(cosine, sine, sqrt(G_squared) * cosine + f * sine), max(f, X(curve.of.top_field())));
  const auto [x_H, slope] = chord_to(curve, f, G_squared);
  const X weight = slope * cosine, sum = weight + sine;
  return sum.value > 0 ? (f * sine + x_H * weight) / sum : x_H;
}

// The root h of cos (B - n h^2) = sin h (B + sign h^2) between 0 and sqrt(B/n), by halving.
X critical_height(int n, double sign, const X& B, const X& sine, const X& cosine) {
  const auto steepness = [&](const X& h) {
    return cosine * (B - double(n) * square(h)) - sine * h * (B + sign * square(h));
  };
  double low = 0, high = std::sqrt(B.value / n);
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (!(low < middle && middle < high)) break;
    (steepness(X(middle)).value > 0 ? low : high) = middle;
  }
  const double slope = -2 * n * cosine.value * high - sine.value * (B.value + 3 * sign * high * high);
  return implicit_root(high, slope, steepness);
}

}  // namespace

HessianJet second_order_bounded(const BoundedCorrection& plain, const CorrectionRule& rule, bool behind, const X& f,
                                const X& G_squared, const X& sine, const X& cosine) {
  if (!(f.value > smallest_field)) return max(f, X(0.0));
  const Curve curve{plain.curve()};
  if (!behind) return projected(curve, rule.projection, f, G_squared, sine, cosine);
  const Kernel& kernel = rule.kernel;
  const double sign = kernel.family == KernelFamily::Cauchy ? 1 : -1, p = (kernel.degree - sign) / 2;
  const X w = plain.unit_w() * pow(f * 0.5, -sign / p), psi = p * f / w;
  const X B = w - sign * (G_squared / (4.0 * square(psi)));
  const X h = critical_height(kernel.degree, sign, B, sine, cosine);
  const X w_D = B + sign * square(h), f_D = f * pow(w_D / w, -sign * p), psi_D = p * f_D / w_D;
  return projected(curve, rule.projection, f_D, square(2.0 * psi_D * h), sine, cosine);
}

}  // namespace marrow
