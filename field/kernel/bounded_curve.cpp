// Newton's method in the parameter of the curve.
#include "field/kernel/bounded_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Newton's method takes 60 steps at most: near the top, a double root, each step halves the error.
constexpr int max_steps = 60;

// The square of what is lower may not be a normal number; x_H is less than 1e-150 there.
constexpr double smallest_height = 1e-150;

// C is f* in whole volumes beside skeletons that lie in each other (|grad_S f| above the top, f below it). Where f* is
// 1 but for rounding these are neither inside nor outside, and none of their rays can be told. By definition 1 is
// outside: so the curve levels off where it is this much below 1, ten times more than bounds of f are widened by, so
// that slopes at the surface are those beyond the top. The height there is the same to within its square.
constexpr double below_iso = 1e-10;

// (a^m - b^m) / (a - b)
double power_quotient(double a, double b, int m) {
  double sum = 0, power = 1;
  for (int i = 0; i < m; ++i) {
    sum = a * sum + power;
    power *= b;
  }
  return sum;
}

}  // namespace

BoundedCurve::BoundedCurve(const Kernel& kernel) {
  const int n = kernel.degree;
  const double shape = kernel.shape;
  if (kernel.family == KernelFamily::Cauchy) {
    k_ = n - 1;
    e_ = n;
    f_max_ = half_power(1 + shape * shape, k_);
    g_0_ = (n - 1) * shape * f_max_;
  } else {
    k_ = n + 1;
    e_ = n - 1;
    f_max_ = 1 / half_power(1 - 1 / (shape * shape), k_);
    g_0_ = (n + 1) * f_max_ / shape;
  }
  u_top_ = std::sqrt(e_ / (e_ + 1.0));
  if (std::fabs(field_at(u_top_) - 1) < below_iso) u_top_ = parameter(1 - below_iso);
  f_top_ = field_at(u_top_);
  g_top_ = height_at(u_top_);
}

double BoundedCurve::parameter(double f) const { return std::min(1.0, root(f / f_max_, k_)); }

double BoundedCurve::field_at(double u) const { return f_max_ * integer_power(u, k_); }

double BoundedCurve::height_at(double u) const { return g_0_ * std::sqrt((1 - u) * (1 + u)) * integer_power(u, e_); }

BoundedCurve::Place BoundedCurve::place(double f) const {
  if (!(f < f_top_)) return {f, g_top_, u_top_};
  const double u = parameter(f);
  return {f, std::min(g_top_, height_at(u)), u};
}

// dg/df = (dg/dv) / (df/dv), dg/dv = g (e/(2v) - 1/(2(1-v))), df/dv = p f / v.
double BoundedCurve::slope(const Place& place) const {
  if (!(place.f < f_top_)) return 0;
  const double v = place.u * place.u;
  return std::max(0.0, place.g / place.f * (e_ - v / (1 - v)) / k_);
}

// e ln v + ln(1-v) = 2 ln(G / g_0) is concave in ln v and rises up to v*, so that Newton's iteration comes from the
// left; it starts where 1-v is left out. ln q >= 2 (q-1) / (q+1) for q >= 1 and exp(x) >= 1 + x + x^2/2 make its steps
// no longer, and keep their order.
BoundedCurve::Place BoundedCurve::place_of_height(double G) const {
  if (!(G > smallest_height * g_0_)) return {0, 0, 0};
  if (!(G < g_top_)) return {f_top_, g_top_, u_top_};
  const double target = (G / g_0_) * (G / g_0_), v_top = u_top_ * u_top_;
  double v = root(target, e_);
  for (int step = 0; step < max_steps; ++step) {
    const double here = integer_power(v, e_) * (1 - v), slope = e_ - v / (1 - v);
    if (!(slope > 0)) return {f_top_, g_top_, u_top_};
    const double by = 2 * (target - here) / ((target + here) * slope),
                 next = std::min(v + v * by * (1 + by / 2), v_top);
    if (!(next - v > epsilon * v)) break;
    v = next;
  }
  const double u = std::sqrt(v);
  return {field_at(u), G, u};
}

// f and g^2 are polynomials in u, from which u - u_H is taken out: with v = u^2 and Q_m = (v^m - v_H^m) / (v - v_H),
// Q_(e+1) = v Q_e + v_H^e, g^2 - g_H^2 = g_0^2 (v - v_H) (Q_e - Q_(e+1)).
double BoundedCurve::chord_slope(const Place& a, const Place& b) const {
  if (!(b.f < f_top_)) return b.f > a.f ? (g_top_ - a.g) / (b.f - a.f) : 0;
  if (!(b.g > 0)) return slope(b);
  const double v = b.u * b.u, other = a.u * a.u;
  const double rise = power_quotient(v, other, e_) * (1 - v) - integer_power(other, e_);
  const double run = f_max_ * power_quotient(b.u, a.u, k_);
  return std::max(0.0, g_0_ / (a.g + b.g) * g_0_ * (a.u + b.u) * rise / run);
}

// By Newton's method for the logarithm of the left side by that of u, in which it is nearly linear: ln q by
// 2 (q-1) / (q+1), exp(x) by (2+x) / (2-x).
double BoundedCurve::on_line(double c, double s, double height) const {
  if (!(height > 0)) return 0;
  if (!(height < g_top_ * c + f_top_ * s)) return s > 0 ? std::max(f_top_, (height - g_top_ * c) / s) : f_top_;
  double low = 0, high = u_top_, u = parameter(std::min(f_top_, height / (s + c * g_top_ / f_top_)));
  for (int step = 0; step < max_steps; ++step) {
    const double f = field_at(u), g = height_at(u), v = u * u;
    const double here = g * c + f * s, slope = c * g * (e_ - v / (1 - v)) + s * k_ * f;
    (here < height ? low : high) = u;
    const double by = 2 * (height - here) / (height + here) * (here / slope);
    double next = u * ((2 + by) / (2 - by));
    if (std::fabs(next - u) <= 2 * epsilon * u || !(high - low > 2 * epsilon * high)) return field_at(next);
    if (!(next > low && next < high)) next = low + (high - low) / 2;
    u = next;
  }
  return field_at(u);
}

}  // namespace marrow
