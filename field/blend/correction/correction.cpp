// Projection onto the reference curve, the cavity correction, and their derivatives.
#include "field/blend/correction/correction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/elementary.h"

namespace marrow {
namespace {

// cos(alpha) of the double nearest pi/2 is 6e-17; closer than this the projection moves nothing.
constexpr double vanishing_cosine = 1e-15;

// Outside this range powers of distances leave the range of double; there C = f, far from every surface.
constexpr double smallest_field = 1e-60, largest_field = 1e100;

// The guard acts where sin a + s cos a falls below this share of s cos a: never for alpha >= 0.
constexpr double guard_share = 0.5;

// From (f, G) horizontally to the reference curve.
struct Chord {
  double x_H;    // where the curve has height G
  double slope;  // of the chord from (x_H, G) to (f, g(f)); the curve's own slope where they meet
};

// With the ratio r = G / g(f): x_H = f r^(1/q), q = n/(n-1), and the slope (g(f) - G) / (f - x_H) is
// g(f)/f (r - 1) / (r^(1/q) - 1), where both differences come from expm1. Eq. 12 of Zanni et al. 2015 is then the mean
// (f sin a + x_H s cos a) / (sin a + s cos a), which is not 0/0 on the curve, nor infinite at pi/2.
Chord chord_to(const ReferenceCurve& curve, double f, double G) {
  const double root = curve.inverse_distance(f);
  const int n = curve.degree();
  const double log_ratio = log(G / ((n - 1) * f * root));
  if (log_ratio == 0) return {f, n * root};
  const double log_x = log_ratio * (n - 1) / n;
  const double step = expm1(log_x);
  const double x_ratio = std::fabs(log_x) < 0.5 ? 1 + step : exp(log_x);
  return {f * x_ratio, (n - 1) * root * (expm1(log_ratio) / step)};
}

// z^3 - k z^2 - p z - k, whose largest root is 1 / eta of the critical point.
double cubic(double z, double k, double p) { return ((z - k) * z - p) * z - k; }
double cubic_slope(double z, double k, double p) { return (3 * z - 2 * k) * z - p; }

}  // namespace

// (f, G) on the curve M_d of two equal unit skeletons 2 a apart, at height a eta over the middle.
struct Correction::TwoSkeletons {
  double r;  // distance to either skeleton
  double c;  // height / r; the tangent's share
  double a;
  CriticalPoint critical;

  double critical_r() const { return a * std::sqrt(1 + critical.eta * critical.eta); }
};

Correction::Correction(int degree, double alpha, bool cavity, Projection projection)
    : curve_(degree), alpha_(alpha), cavity_(cavity), projection_(projection) {
  const auto [s, c] = sincos(alpha);
  sin_ = s;
  cos_ = c;
  is_sum_ = c < vanishing_cosine;
  if (alpha < 0) projection_ = Projection::Paper;
}

Correction::Correction(const Kernel& kernel, double alpha, bool cavity, Projection projection)
    : Correction(kernel.degree, alpha, cavity, projection) {
  if (kernel.family != KernelFamily::Inverse) bounded_.emplace(kernel, alpha, cavity, projection);
}

std::optional<double> Correction::trivial(double f) const {
  if (f > smallest_field && f < largest_field && !is_sum_) return {};
  return std::max(f, 0.0);
}

double Correction::projected(double f, double G) const {
  const auto [x_H, slope] = chord_to(curve_, f, G);
  const double weight = slope * cos_, sum = weight + sin_;
  if (sum < guard_share * weight) return std::max(0.0, 2 * x_H - f);
  const double value = std::max(0.0, (f * sin_ + x_H * weight) / sum);
  return projection_ == Projection::Exact ? projected_exactly(value, f * sin_ + G * cos_, std::max(x_H, f)) : value;
}

// The root x of g(x) cos + x sin = height; eq. 12 is the start. The function is convex and increasing, so that
// after one step Newton's iteration comes from the right.
double Correction::projected_exactly(double start, double height, double largest) const {
  double x = start;
  for (int step = 0; step < 30; ++step) {
    const double root = curve_.inverse_distance(x);
    const double excess = (curve_.degree() - 1) * x * root * cos_ + x * sin_ - height;
    const double slope = curve_.degree() * root * cos_ + sin_;
    if (!(slope > 0)) return x;
    const double next = std::clamp(x - excess / slope, 0.0, largest);
    if (std::fabs(next - x) <= 4 * std::numeric_limits<double>::epsilon() * x) return next;
    x = next;
  }
  return x;
}

ProjectedSlopes Correction::projected_slopes(double f, double G) const {
  const double value = projected(f, G);
  if (projection_ == Projection::Exact) {
    const double sum = curve_.slope(value) * cos_ + sin_;
    // along the root of g(x) cos + x sin = G cos + f sin
    const double dalpha = ((f - value) * cos_ + (curve_.at(value) - G) * sin_) / sum;
    return {value, sin_ == 0 ? 0 : sin_ / sum, cos_ / sum, dalpha};
  }
  const auto [x_H, slope] = chord_to(curve_, f, G);
  const double weight = slope * cos_, sum = weight + sin_, slope_at_H = curve_.slope(x_H);
  if (value == 0) return {0, 0, 0, 0};
  if (sum < guard_share * weight) return {value, -1, 2 / slope_at_H, 0};
  // the derivatives of the mean with the terms collected, so that each is positive for alpha >= 0
  const double df = sin_ * (2 * weight + sin_ - curve_.slope(f) * cos_) / (sum * sum);
  const double dG = (weight * (weight / slope_at_H) + cos_ * sin_) / (sum * sum);
  return {value, df, dG, slope * (f - x_H) / (sum * sum)};
}

// The root of sin a (eta^3 + eta) + cos (n eta^2 - 1) = 0 with the least eta, in closed form by z = 1 / eta and
// z = k/3 + y: y^3 - P y = Q.   [Zanni et al. 2015, sec. 4.2, with -tan(alpha) in step 2]
Correction::CriticalPoint Correction::critical_point(double a) const {
  const int n = degree();
  const double tangent = sin_ / cos_, k = a * tangent;
  const double P = k * k / 3 + n, Q = 2 * k * k * k / 27 + n * k / 3 + k;
  const double half_width = std::sqrt(P / 3), w = 3 * Q / (2 * P * half_width);
  if (w <= -1) {
    // alpha < 0 and M_d is nowhere so steep: its steepest point serves, z at the minimum of the cubic's outer arm
    const double eta = 1 / (k / 3 + half_width);
    const double by_k = -eta * eta * (1.0 / 3 + k / (9 * half_width));
    return {eta, -eta * eta * (tangent / 3 + k * tangent / (9 * half_width)), by_k * a / (cos_ * cos_), true};
  }
  double z = k / 3 + 2 * half_width * (w <= 1 ? cos(acos(w) / 3) : cosh(acosh(w) / 3));
  if (alpha_ >= 0) z -= cubic(z, k, n) / cubic_slope(z, k, n);
  // dk/da = tangent, dk/dalpha = a / cos^2, and d(cubic) = 0 along the root
  const double z_slope = tangent * (z * z + 1) / cubic_slope(z, k, n);
  const double z_by_alpha = a / (cos_ * cos_) * ((z * z + 1) / cubic_slope(z, k, n));
  return {1 / z, -z_slope / (z * z), -z_by_alpha / (z * z)};
}

// Step 1 of the cavity correction finds the curve M_d through (f, G), step 2 its critical point.
std::optional<Correction::TwoSkeletons> Correction::behind_critical_point(double f, double G) const {
  if (!cavity_) return {};
  const int n = degree();
  const double r = 1 / curve_.inverse_distance(f / 2);
  const double c = G * integer_power(r, n) / (2 * (n - 1));
  if (!(c < 1)) return {};
  const double flatness = std::sqrt((1 - c) * (1 + c));
  const double a = r * flatness, eta = c / flatness;
  // For alpha >= 0 the sign tells which side of the only root eta is, without solving.
  if (alpha_ >= 0 && !(sin_ * a * (eta * eta + 1) * eta + cos_ * (n * eta * eta - 1) < 0)) return {};
  const CriticalPoint critical = critical_point(a);
  if (!(eta < critical.eta)) return {};
  return TwoSkeletons{r, c, a, critical};
}

bool Correction::in_cavity_branch(double f, double G) const {
  if (trivial(f)) return false;
  return bounded_ ? bounded_->in_cavity_branch(f, G) : behind_critical_point(f, G).has_value();
}

double Correction::value(double f, double G) const {
  if (const auto v = trivial(f)) return *v;
  if (bounded_) return bounded_->value(f, G);
  const auto two = behind_critical_point(f, G);
  if (!two) return projected(f, G);
  const int n = degree();
  const double power = 1 / integer_power(two->critical_r(), n - 1);
  const double height = two->a * two->critical.eta;
  return projected(2 * power, 2 * (n - 1) * power * height / (two->critical_r() * two->critical_r()));
}

// In the cavity branch C is a function of a alone: d(a^2) along f and G, times dC/da along the critical points.
Correction::Partials Correction::partials(double f, double G) const {
  if (const auto v = trivial(f)) return {.value = *v, .df = 1, .dG = 0, .dG_over_G = 0, .dalpha = 0};
  if (bounded_) return bounded_->partials(f, G);
  const auto two = behind_critical_point(f, G);
  if (!two) return projected_slopes(f, G).partials_at(G);
  const int n = degree();
  const auto [r, c, a, critical] = *two;
  const double eta = critical.eta, r_D = two->critical_r();
  const double power = 1 / integer_power(r_D, n - 1);
  const double D_f = 2 * power, D_G = 2 * (n - 1) * power * (a * eta) / (r_D * r_D);
  const ProjectedSlopes at_D = projected_slopes(D_f, D_G);
  const double r_slope = (r_D * r_D + a * a * a * eta * critical.eta_slope) / (a * r_D);
  const double D_f_slope = -(n - 1) * D_f * r_slope / r_D;
  const double D_G_slope = D_G * (-(n + 1) * r_slope / r_D + 1 / a + critical.eta_slope / eta);
  const double along_a = at_D.df * D_f_slope + at_D.dG * D_G_slope;
  // alpha moves eta alone: d r_D / d eta = a^2 eta / r_D
  const double r_by_alpha = a * a * eta / r_D * critical.eta_by_alpha;
  const double along_alpha = at_D.df * (-(n - 1) * D_f * r_by_alpha / r_D) +
                             at_D.dG * D_G * (-(n + 1) * r_by_alpha / r_D + critical.eta_by_alpha / eta);
  // a^2 = r^2 - w^2, w = G r^(n+1) / (2(n-1)) = c r, r = (2/f)^(1/(n-1))
  const double lift = integer_power(r, n + 1) / (2 * (n - 1));
  const double a_by_f = -r * r * (1 - (n + 1) * c * c) / ((n - 1) * f * a);
  const double a_by_G_over_G = -lift * lift / a;
  return {.value = at_D.value,
          .df = along_a * a_by_f,
          .dG = along_a * a_by_G_over_G * G,
          .dG_over_G = along_a * a_by_G_over_G,
          .dalpha = at_D.dalpha + along_alpha};
}

}  // namespace marrow
