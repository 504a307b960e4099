// Projection and cavity correction of the inverse kernel; the same formulas as in correction.cpp, in forms that can be
// differentiated twice.
#include "field/blend/correction/second_order_correction.h"

#include <algorithm>
#include <cmath>

#include "field/blend/correction/correction.h"
#include "field/blend/correction/second_order_bounded.h"
#include "field/number/quotients.h"
#include "field/skeleton/implicit_root.h"

namespace marrow {
namespace {

using X = HessianJet;

// As in correction.cpp.
constexpr double guard_share = 0.5, smallest_gradient = 1e-150;

struct Direction {
  X sine, cosine;
};

X power(const X& x, double exponent) { return pow(x, exponent); }

// Without quotients of small numbers, whose second derivatives leave the range of doubles long before they do.
X logarithm(const X& x) { return log(x * (1 / x.value)) + log(x.value); }

// x_H = f e^L with L = ln(G / g) (n-1)/n, and the slope of the chord (n-1) f^(1/(n-1)) expm1(q L) / expm1(L),
// q = n/(n-1).   [chord_to() in correction.cpp]
struct Chord {
  X x_H, slope;
};
Chord chord_to(int n, const X& f, const X& G_squared) {
  const X root = power(f, 1.0 / (n - 1)), height = (n - 1.0) * f * root;
  if (!(G_squared.value > smallest_gradient * smallest_gradient)) return {X(0.0), (n - 1.0) * root};
  const double q = n / (n - 1.0);
  const X log_ratio = 0.5 * logarithm(G_squared) - logarithm(height), step = log_ratio * (1 / q);
  return {f * exp(step), (n - 1.0) * root * (exp_quotient(log_ratio) * q / exp_quotient(step))};
}

// The root x of g(x) cos + x sin = height.
X projected_exactly(int n, const X& f, const X& G_squared, const Direction& to, double alpha) {
  const double G = std::sqrt(G_squared.value);
  const double root = Correction(n, alpha, false, Projection::Exact).value(f.value, G);
  if (!(root > 0)) return X(0.0);
  const X height = f * to.sine + sqrt(G_squared) * to.cosine;
  const double slope = n * pow(root, 1.0 / (n - 1)) * to.cosine.value + to.sine.value;
  return implicit_root(
      root, slope, [&](const X& x) { return (n - 1.0) * power(x, n / (n - 1.0)) * to.cosine + x * to.sine - height; });
}

X projected(const CorrectionRule& rule, const X& f, const X& G_squared, const Direction& to, double alpha) {
  const int n = rule.kernel.degree;
  if (rule.projection == Projection::Exact && alpha >= 0) return projected_exactly(n, f, G_squared, to, alpha);
  const auto [x_H, slope] = chord_to(n, f, G_squared);
  const X weight = slope * to.cosine, sum = weight + to.sine;
  if (sum.value < guard_share * weight.value) return max(2.0 * x_H - f, X(0.0));
  return max((f * to.sine + x_H * weight) / sum, X(0.0));
}

// The largest root z = 1 / eta of z^3 - k z^2 - n z - k, k = a tan(alpha); for alpha < 0, where there may be none, the
// steepest point instead, at the minimum of the cubic.   [Zanni et al. 2015, sec. 4.2]
X inverse_height(int n, const X& k) {
  const auto cubic = [&](double z) { return ((z - k.value) * z - n) * z - k.value; };
  const X steepest = k * (1.0 / 3) + sqrt(square(k) * (1.0 / 9) + n / 3.0);
  if (k.value < 0 && cubic(steepest.value) >= 0) return steepest;
  double z =
      std::max(k.value, 0.0) + std::sqrt(static_cast<double>(n));  // right of the root, where the cubic is convex
  const auto slope_at = [&](double x) { return (3 * x - 2 * k.value) * x - n; };
  for (int step = 0; step < 60; ++step) {
    const double next = z - cubic(z) / slope_at(z);
    if (!(next < z)) break;
    z = next;
  }
  return implicit_root(z, slope_at(z), [&](const X& x) { return ((x - k) * x - double(n)) * x - k; });
}

// In the cavity branch C is that of the critical point of M_d.   [Zanni et al. 2015, sec. 4.2]
X behind_critical_point(const CorrectionRule& rule, const X& f, const X& G_squared, const Direction& to, double alpha) {
  const int n = rule.kernel.degree;
  const X r_squared = power(f * 0.5, -2.0 / (n - 1));
  const double K = 1 / (4.0 * (n - 1) * (n - 1));
  const X a = sqrt(r_squared - G_squared * integer_power(r_squared, n + 1) * K);
  const X eta = 1.0 / inverse_height(n, a * (to.sine / to.cosine));
  const X r_D = a * sqrt(1.0 + square(eta)), fall = 1.0 / integer_power(r_D, n - 1);
  return projected(rule, 2.0 * fall, square(2.0 * (n - 1) * fall / square(r_D) * (a * eta)), to, alpha);
}

}  // namespace

HessianJet second_order_correction(const CorrectionRule& rule, const X& f, const X& G_squared, const X& alpha) {
  const Correction plain(rule.kernel, alpha.value, rule.cavity, rule.projection);
  const double G = std::sqrt(G_squared.value);
  if (plain.is_trivial(f.value)) return max(f, X(0.0));
  const Direction to{sin(alpha), cos(alpha)};
  const bool behind = plain.in_cavity_branch(f.value, G);
  if (plain.bounded()) return second_order_bounded(*plain.bounded(), rule, behind, f, G_squared, to.sine, to.cosine);
  return behind ? behind_critical_point(rule, f, G_squared, to, alpha.value)
                : projected(rule, f, G_squared, to, alpha.value);
}

}  // namespace marrow
