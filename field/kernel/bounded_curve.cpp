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

}  // namespace

BoundedCurve::BoundedCurve(const Kernel& kernel) {
  const int n = kernel.degree;
  const double shape = kernel.shape;
  if (kernel.family == KernelFamily::Cauchy) {
    p_ = (n - 1) / 2.0;
    e_ = n;
    f_max_ = pow(1 + shape * shape, p_);
    g_0_ = (n - 1) * shape * f_max_;
  } else {
    p_ = (n + 1) / 2.0;
    e_ = n - 1;
    f_max_ = pow(1 - 1 / (shape * shape), -p_);
    g_0_ = (n + 1) * f_max_ / shape;
  }
  v_top_ = e_ / (e_ + 1.0);
  f_top_ = field_at(v_top_);
  g_top_ = height_at(v_top_);
}

double BoundedCurve::parameter(double f) const { return std::min(1.0, pow(f / f_max_, 1 / p_)); }

// p is half of a whole number, as e / 2 is.
double BoundedCurve::field_at(double v) const { return f_max_ * half_power(v, static_cast<int>(2 * p_)); }

double BoundedCurve::height_at(double v) const { return g_0_ * std::sqrt(1 - v) * half_power(v, e_); }

double BoundedCurve::at(double f) const { return f < f_top_ ? std::min(g_top_, height_at(parameter(f))) : g_top_; }

// dg/df = (dg/dv) / (df/dv), dg/dv = g (e/(2v) - 1/(2(1-v))), df/dv = p f / v.
double BoundedCurve::slope(double f) const {
  if (!(f < f_top_)) return 0;
  const double v = parameter(f);
  return std::max(0.0, height_at(v) / f * (e_ - v / (1 - v)) / (2 * p_));
}

// e ln v + ln(1-v) = 2 ln(G / g_0) is concave and rises up to v*, so that Newton's iteration comes from the left;
// it starts where 1-v is left out.
double BoundedCurve::inverse(double G) const {
  if (!(G > 0)) return 0;
  if (!(G < g_top_)) return f_top_;
  const double target = 2 * log(G / g_0_);
  double v = exp(target / e_);
  for (int step = 0; step < max_steps && v > 0; ++step) {
    const double rest = target - (e_ * log(v) + log1p(-v));
    const double slope = e_ / v - 1 / (1 - v);
    if (!(slope > 0)) return f_top_;
    const double next = std::min(v + rest / slope, v_top_);
    if (!(next - v > epsilon * v)) break;
    v = next;
  }
  return field_at(v);
}

// With L = ln(v_H / v_f): x_H / f = e^(pL) and G / g(f) = e^(eL/2) sqrt((1-v_H)/(1-v_f)), both differences by expm1.
double BoundedCurve::chord_slope(double f, double G, double x_H) const {
  if (!(f < f_top_)) return f > x_H ? (g_top_ - G) / (f - x_H) : 0;
  if (x_H == 0) return at(f) / f;
  const double v = parameter(f), ratio = log(x_H / f) / p_;
  if (ratio == 0) return slope(f);
  const double rise = expm1(ratio * e_ / 2 + log1p(-v * expm1(ratio) / (1 - v)) / 2);
  return std::max(0.0, height_at(v) / f * (rise / expm1(ratio * p_)));
}

double BoundedCurve::on_line(double c, double s, double height) const {
  if (!(height > 0)) return 0;
  if (!(height < g_top_ * c + f_top_ * s)) return s > 0 ? std::max(f_top_, (height - g_top_ * c) / s) : f_top_;
  double low = 0, high = v_top_, v = parameter(std::min(f_top_, height / (s + c * g_top_ / f_top_)));
  for (int step = 0; step < max_steps; ++step) {
    const double f = field_at(v), g = height_at(v);
    const double excess = g * c + f * s - height;
    (excess < 0 ? low : high) = v;
    const double slope = (c * g * (e_ - v / (1 - v)) / 2 + s * p_ * f) / v;
    double next = v - excess / slope;
    if (!(next > low && next < high)) next = low + (high - low) / 2;
    if (std::fabs(next - v) <= 2 * epsilon * v || !(high - low > 2 * epsilon * high)) return field_at(next);
    v = next;
  }
  return field_at(v);
}

}  // namespace marrow
