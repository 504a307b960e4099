// Projection and cavity correction on the outer branch of a bounded curve.
#include "field/blend/correction/bounded_correction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr double smallest_field = 1e-60;  // powers of less leave the range of double

// +1 for Cauchy, -1 for compact: the sign of h^2 in w.
double sign_of(const Kernel& kernel) { return kernel.family == KernelFamily::Cauchy ? 1 : -1; }

double unit_w_of(const Kernel& kernel) {
  const double shape_squared = kernel.shape * kernel.shape;
  return kernel.family == KernelFamily::Cauchy ? 1 + 1 / shape_squared : shape_squared - 1;
}

}  // namespace

struct BoundedCorrection::TwoSkeletons {
  Pair here, critical;
};

BoundedCorrection::BoundedCorrection(const Kernel& kernel, double alpha, bool cavity, Projection projection)
    : kernel_(kernel), curve_(kernel), w_1_(unit_w_of(kernel)), cavity_(cavity), projection_(projection) {
  const auto [s, c] = sincos(std::max(alpha, 0.0));
  sin_ = s;
  cos_ = c;
}

double BoundedCorrection::projected(const Place& at) const { return projected(curve_.place(at.f), at.G); }

// Above the curve, or exactly: the curve itself. Else the chord as a weighted mean.
double BoundedCorrection::projected(const BoundedCurve::Place& place, double G) const {
  const double f = place.f;
  if (!is_on_chord(place, G))
    return std::min(curve_.on_line(cos_, sin_, G * cos_ + f * sin_), std::max(f, curve_.top_field()));
  return Chord(*this, place, G).value;
}

bool BoundedCorrection::is_on_chord(const BoundedCurve::Place& place, double G) const {
  return projection_ == Projection::Paper && G < place.g;
}

BoundedCorrection::Chord::Chord(const BoundedCorrection& of, const BoundedCurve::Place& place, double G)
    : end(of.curve_.place_of_height(G)),
      slope(of.curve_.chord_slope(end, place)),
      weight(slope * of.cos_),
      sum(weight + of.sin_),
      value(sum > 0 ? (place.f * of.sin_ + end.f * weight) / sum : end.f) {}

ProjectedSlopes BoundedCorrection::projected_slopes(double f, double G) const {
  const BoundedCurve::Place place = curve_.place(f);
  if (!is_on_chord(place, G)) {
    const double value = projected(place, G);
    const BoundedCurve::Place root = curve_.place(value);
    const double slope = curve_.slope(root), sum = slope * cos_ + sin_;
    if (value >= std::max(f, curve_.top_field())) return {value, f > curve_.top_field() ? 1.0 : 0.0, 0, 0};
    if (sum == 0) return {value, 0, 0, 0};  // beyond the top with alpha = 0: level
    const double dalpha = ((f - value) * cos_ + (root.g - G) * sin_) / sum;
    return {value, sin_ / sum, cos_ / sum, dalpha};
  }
  const auto [end, slope, weight, sum, value] = Chord(*this, place, G);
  const double slope_at_H = curve_.slope(end);
  if (!(sum > 0)) return {value, 0, 0, 0};
  // As of Correction; at the top both the chord and the curve are level, and what is left is their common limit
  const double df = sin_ * (2 * weight + sin_ - curve_.slope(place) * cos_) / (sum * sum);
  const double steep = slope_at_H > 0 ? weight * (weight / slope_at_H) : 0;
  return {value, df, (steep + cos_ * sin_) / (sum * sum), slope * (f - end.f) / (sum * sum)};
}

// From f: w; from G: h = G / (2 psi).
BoundedCorrection::Pair BoundedCorrection::pair_at(double f, double G) const {
  const double sign = sign_of(kernel_), p = curve_.field_power(), u = root(f / 2, curve_.twice_field_power());
  const double w = sign > 0 ? w_1_ / (u * u) : w_1_ * (u * u), psi = p * f / w, h = G / (2 * psi);
  return {w, psi, h, w - sign * (h * h)};
}

// Positive while M, seen from the middle outward, is steeper than -tan(alpha).
double BoundedCorrection::steepness(double h, double B) const {
  return cos_ * (B - kernel_.degree * (h * h)) - sin_ * h * (B + sign_of(kernel_) * (h * h));
}

// The root of steepness() in (0, sqrt(B/n)], where it falls from B cos(alpha) to no more than 0.
double BoundedCorrection::critical_height(double B) const {
  const double sign = sign_of(kernel_);
  double low = 0, high = std::sqrt(B / kernel_.degree), h = high;
  for (int step = 0; step < 100; ++step) {
    const double value = steepness(h, B);
    (value > 0 ? low : high) = h;
    const double slope = -2 * kernel_.degree * cos_ * h - sin_ * (B + 3 * sign * (h * h));
    double next = h - value / slope;
    if (!(next >= low && next <= high)) next = low + (high - low) / 2;
    if (std::fabs(next - h) <= 2 * std::numeric_limits<double>::epsilon() * h) return next;
    h = next;
  }
  return h;
}

std::optional<BoundedCorrection::TwoSkeletons> BoundedCorrection::behind_critical_point(double f, double G) const {
  if (!cavity_) return {};
  const Pair here = pair_at(f, G);
  const double n = kernel_.degree, sign = sign_of(kernel_), p = curve_.field_power();
  if (!(cos_ * (here.B - n * (here.h * here.h)) - sin_ * here.h * here.w > 0)) return {};
  Pair critical{.w = 0, .psi = 0, .h = critical_height(here.B), .B = here.B};
  critical.w = here.B + sign * (critical.h * critical.h);
  // k falls (rises) with w as its power; taken from here to there, so that nothing is lost
  const double f_critical =
      f * half_power(sign > 0 ? here.w / critical.w : critical.w / here.w, curve_.twice_field_power());
  critical.psi = p * f_critical / critical.w;
  return TwoSkeletons{here, critical};
}

bool BoundedCorrection::in_cavity_branch(double f, double G) const {
  return f > smallest_field && behind_critical_point(f, G).has_value();
}

BoundedCorrection::Place BoundedCorrection::projected_from(double f, double G) const {
  const auto two = f > smallest_field ? behind_critical_point(f, G) : std::nullopt;
  if (!two) return {f, G};
  const Pair& D = two->critical;
  return {D.psi * D.w / curve_.field_power(), 2 * D.psi * D.h};
}

double BoundedCorrection::value(double f, double G) const {
  return f > smallest_field ? projected(projected_from(f, G)) : std::max(f, 0.0);
}

// In the cavity branch C is a function of B alone, and B of f and G^2.
CorrectionPartials BoundedCorrection::partials(double f, double G) const {
  if (!(f > smallest_field)) return {.value = std::max(f, 0.0), .df = 1, .dG = 0, .dG_over_G = 0, .dalpha = 0};
  const auto two = behind_critical_point(f, G);
  if (!two) return projected_slopes(f, G).partials_at(G);
  const double n = kernel_.degree, sign = sign_of(kernel_), p = curve_.field_power();
  const auto& [here, D] = *two;
  const double h = D.h, D_f = D.psi * D.w / p, D_G = 2 * D.psi * h;
  const ProjectedSlopes at_D = projected_slopes(D_f, D_G);
  // along steepness(h, B; alpha) = 0
  const double by_h = -2 * n * cos_ * h - sin_ * (D.B + 3 * sign * (h * h));
  const double h_by_B = -(cos_ - sin_ * h) / by_h, h_by_alpha = (sin_ * (D.B - n * (h * h)) + cos_ * h * D.w) / by_h;
  // D_f ~ w^(-sign p), D_G ~ h w^(-sign p - 1)
  const auto along = [&](double w_slope, double h_slope) {
    return at_D.df * (-sign * p * D_f / D.w * w_slope) +
           at_D.dG * D_G * ((-sign * p - 1) / D.w * w_slope + h_slope / h);
  };
  const double by_B = along(1 + 2 * sign * h * h_by_B, h_by_B);
  const double B_by_f = -sign * here.w / (p * f) * (1 - 2 * (here.h * here.h) * (p + sign) / here.w);
  const double dG_over_G = by_B * (-sign / (2 * here.psi * here.psi));
  return {.value = at_D.value,
          .df = by_B * B_by_f,
          .dG = dG_over_G * G,
          .dG_over_G = dG_over_G,
          .dalpha = at_D.dalpha + along(2 * sign * h * h_by_alpha, h_by_alpha)};
}

bool BoundedCorrection::solid_alone() const {
  constexpr int samples = 64;
  for (int i = 0; i <= samples; ++i) {
    const double share = static_cast<double>(i) / samples;
    const double f = std::max(1.0, curve_.top_field()) * (1 - share) + curve_.largest_field() * share;
    if (f > 1 && !(value(f, curve_.alone_at(f)) > 1)) return false;
  }
  return true;
}

}  // namespace marrow
