#include "field/blend/bounds/sum/sum_bounds.h"

#include <algorithm>
#include <cmath>

#include "field/blend/bounds/sum/least_field.h"
#include "field/kernel/profile.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/parts.h"
#include "field/skeleton/radii.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;

Interval pad(double x, double by) { return {rounding::down(x - by), rounding::up(x + by)}; }

}  // namespace

double SkewBox::radius() const {
  const auto& [a, b, c] = halves;
  const double longest = std::max({length(a + b + c), length(a + b - c), length(a - b + c), length(a - b - c)});
  return longest * (1 + 1e-15) + slack;
}

SumBounds::SumBounds(const Box3& box, const Within& within)
    : box_(box), center_(box.center()), rho_(0.5 * length(box.size()) * (1 + 1e-15)) {
  if (within.stretch != nullptr) {
    stretch_ = *within.stretch;
    skew_ = SkewBox{{stretch_->half, {}, {}}, stretch_->slack};
  } else if (within.skew != nullptr) {
    skew_ = *within.skew;
  }
  if (skew_) rho_ = skew_->radius();
}

SumBounds::SumBounds(const BlendField& blend, const Box3& box, Wanted wanted, const Within& within)
    : SumBounds(box, within) {
  has_gradient_ = wanted == Wanted::Slopes;
  keeps_parts_ = blend.alpha_per_skeleton || !blend.direction_bounds.empty() || blend.local_contact;
  if (blend.kernel == KernelFamily::Inverse) add_inverse(blend);
  if (blend.kernel == KernelFamily::Cauchy) add_cauchy(blend);
  if (blend.kernel == KernelFamily::Compact) add_compact(blend);
  add_distances(blend);
}

void SumBounds::add(const SkeletonSample& s, double distance, double radius, int m) {
  keep({.sample = s, .distance = distance, .m = m});
  ++added_;
  const double q = rho_ / distance;
  log_slope_ = std::max(log_slope_, q < 1 ? m / (distance - rho_) * (1 + 1e-12) : inf);
  if (!(q < 0.9) || !std::isfinite(s.value)) {
    // Anything may happen above what the farthest distances leave.
    unbounded_ = true;
    if (std::isfinite(s.value) && distance > 0) low_ += s.value / integer_power(1 + q, m) * (1 - 1e-10);
    return;
  }
  const double shrink = 1 / (1 - q), grown = integer_power(shrink, m + 2) * s.value / (distance * distance);
  const double most = integer_power(shrink, m) * s.value;
  add(Most{most, most * shrink * m * radius / distance});
  f_ += s.value;
  low_ += s.value / integer_power(1 + q, m) * (1 - 1e-10);
  gradient_ += s.gradient;
  S_ += s.si_gradient;
  J_ += s.si_jacobian;
  second_ += m * (m + 1) * grown;
  S_second_ += m * (m + 1) * (m + 2) * grown * radius * shrink / distance;
  error_ += sample_error * s.value;
  slope_error_ += sample_error * (m * s.value / distance);
  S_error_ += sample_error * (m * s.value * radius / distance);
}

// To second order, or, in boxes so large that it says less, to first. With v = a u + w, u along the primitive, |v H v|
// is at most most_bent w^2 + ends_bent (a^2 + 2 a w).
void SumBounds::add(const SkeletonSample& s, const Smooth& b) {
  ++added_;
  const double longest = b.steepest * b.radius, most_J = b.most_bent * b.radius;
  const double J_by = b.J_changes + b.ends_J_changes * rho_ + compact_error * most_J;
  const bool has_J = J_by < most_J;
  const double S_by = (has_J ? b.S_beyond_J + compact_error * most_J * b.across : most_J * b.across) +
                      b.ends_J_changes * rho_ * (b.across + rho_) + compact_error * longest;
  const double bent = b.most_bent * b.across * b.across + b.ends_bent * rho_ * (rho_ + 2 * b.across);
  log_slope_ = inf;
  f_ += s.value;
  error_ += compact_error * s.value;
  if (0.5 * bent < b.steepest * rho_) {
    gradient_ += s.gradient;
    error_ += 0.5 * bent;
    slope_error_ += b.most_bent * b.across + b.ends_bent * rho_ + compact_error * b.steepest;
  } else {
    error_ += b.steepest * rho_;
    slope_error_ += b.steepest;
  }
  low_ += std::max(0.0, s.value * (1 - compact_error) - b.steepest * rho_);
  add(Most{s.value * (1 + compact_error) + b.steepest * rho_, longest});
  const bool is_near = S_by < longest;
  if (is_near) S_ += s.si_gradient;
  if (is_near && has_J) J_ += s.si_jacobian;
  S_error_ += std::min(longest, S_by) * (1 + 1e-9);
  J_error_ += is_near && has_J ? J_by : most_J;
}

// Within rho distances shrink by 1 - rho / nearest at most, and B3 and B4 hold with the sums of the sources.
void SumBounds::add(const SourceSums& sources) {
  ++added_;
  const SourceSample s = sources.at(center_);
  const int m = sources.exponent();
  const double q = rho_ / s.nearest, f = s.sum.value;
  log_slope_ = std::max(log_slope_, q < 1 ? m / (s.nearest - rho_) * (1 + 1e-12) : inf);
  // one factor for all of them tells little where one is near
  low_ += (q < 0.2 ? f / integer_power(1 + q, m) : sources.least_within(center_, rho_)) * (1 - 1e-10);
  if (!(q < 0.9)) {
    unbounded_ = true;
    return;
  }
  const double shrink = (1 + 1e-12) / (1 - q), grown = integer_power(shrink, m + 2);
  // The sum of w tau D^-(m+1) is at most the geometric mean of those of w tau D^-m and w tau D^-(m+2)
  // [Cauchy, Schwarz].
  const double most = integer_power(shrink, m);
  add(Most{most * f, most * shrink * m * std::sqrt(f * sources.largest_radius() * s.pull)});
  f_ += f;
  gradient_ += s.sum.gradient;
  S_ += s.sum.si_gradient;
  J_ += s.sum.si_jacobian;
  second_ += m * (m + 1) * grown * s.second;
  S_second_ += m * (m + 1) * (m + 2) * grown * shrink * s.third;
  error_ += sample_error * f;
  slope_error_ += sample_error * (m * f / s.nearest);
  S_error_ += sample_error * (m * f * sources.largest_radius() / s.nearest);
}

void SumBounds::add(const FarPolynomial& far) {
  ++added_;
  const SkeletonSample s = far.at(center_);
  const FarPolynomial::Bounds& b = far.bounds();
  log_slope_ = std::max(log_slope_, b.log_slope);
  f_ += s.value;
  low_ += std::max(0.0, s.value * (1 - 1e-10) - b.steepest * rho_);
  add(Most{s.value * (1 + sample_error) + b.steepest * rho_, b.S_longest});
  gradient_ += s.gradient;
  S_ += s.si_gradient;
  J_ += s.si_jacobian;
  second_ += b.second;
  S_second_ += b.S_second;
  error_ += sample_error * s.value;
  slope_error_ += sample_error * b.steepest;
  S_error_ += sample_error * b.S_longest;
}

void SumBounds::add(const Most& b) {
  most_.f += b.f;
  most_.S += b.S;
}

void SumBounds::add(const Between& b) {
  const Interval& f = b.f;
  if (f.hi > 0) {
    ++added_;
    on_curve_ += b.is_on_curve;
  }
  log_slope_ = std::max(log_slope_, b.log_slope);
  if (b.slopes) {
    for (std::size_t i = 0; i < 3; ++i) {
      between_.gradient[i] += b.slopes->gradient[i];
      for (std::size_t j = 0; j < 3; ++j) between_.J[i][j] += b.slopes->J[i][j];
    }
  } else {
    has_gradient_ = false;
  }
  has_slopes_ = has_slopes_ && !b.S_jumps;
  low_ += std::max(0.0, f.lo);
  if (!(f.hi < inf)) {
    unbounded_ = true;
    return;
  }
  add(Most{f.hi, length(b.S) + b.S_by});
  f_ += f.middle();
  error_ += 0.5 * f.width() * (1 + 1e-15) + 1e-15 * f.hi;
  S_ += b.S;
  S_error_ += b.S_by;
}

// How much something of this slope changes from the middle on.
Interval SumBounds::change(const Vec3d& slope) const {
  if (skew_) {
    double by = length(slope) * (skew_->slack + 3e-15 * rho_);
    for (const Vec3d& half : skew_->halves) by += std::fabs(dot(slope, half));
    return {rounding::down(-by), rounding::up(by)};
  }
  Interval all;
  for (std::size_t i = 0; i < 3; ++i)
    all += Interval(slope[i]) * (Interval(box_.lower[i], box_.upper[i]) - Interval(center_[i]));
  return all;
}

Interval SumBounds::f_along() const {
  const Vec3d& d = stretch_->direction;
  const double turn = stretch_->turn, size = length(d) * (1 + 1e-12) + turn;
  Interval x = pad(dot(gradient_, d),
                   size * (second_ * rho_ + slope_error_ + 1e-14 * length(gradient_)) + turn * length(gradient_));
  for (std::size_t i = 0; i < 3; ++i) x += between_.gradient[i] * pad(d[i], turn);
  return x;
}

Interval SumBounds::S_along(std::size_t i) const {
  const Vec3d& d = stretch_->direction;
  const double turn = stretch_->turn, size = length(d) * (1 + 1e-12) + turn, row = length(J_.rows[i]);
  Interval x = pad(dot(J_.rows[i], d), size * (S_second_ * rho_ + sample_error * row + J_error_) + turn * row);
  for (std::size_t j = 0; j < 3; ++j) x += between_.J[i][j] * pad(d[j], turn);
  return x;
}

Interval SumBounds::f() const {
  if (unbounded_) return {low_ * (1 - 1e-12), inf};
  Interval x = pad(f_, error_ + 0.5 * second_ * rho_ * rho_);
  x += change(gradient_);
  return {std::max({0.0, x.lo, low_ * (1 - 1e-12)}), std::max(0.0, std::min(x.hi, most_.f * (1 + 1e-9)))};
}

Vec3<Interval> SumBounds::gradient() const {
  if (!has_gradient()) return {Interval::everything(), Interval::everything(), Interval::everything()};
  const double by = second_ * rho_ + slope_error_;
  return Vec3<Interval>{pad(gradient_.x, by), pad(gradient_.y, by), pad(gradient_.z, by)} + between_.gradient;
}

Vec3<Interval> SumBounds::S() const {
  Vec3<Interval> s;
  const double by = S_error_ + 0.5 * S_second_ * rho_ * rho_;
  for (std::size_t i = 0; i < 3; ++i) s[i] = pad(S_[i], by) + change(J_.rows[i]);
  return s;
}

Interval SumBounds::J(std::size_t i, std::size_t j) const {
  if (!has_slopes()) return Interval::everything();
  return pad(J_.rows[i][j], S_second_ * rho_ + sample_error * std::fabs(J_.rows[i][j]) + J_error_) + between_.J[i][j];
}

// Where the box comes near, a sample would tell little, and nothing at all on the skeleton.
template <class Skeleton, class Sample>
void SumBounds::add_integral(const BlendField& blend, const Skeleton& s, double distance, int m, const Sample& sample) {
  if (rho_ < (dimension_of(s) == 2 ? 0.7 : 0.9) * distance) {
    add(sample(), distance, largest_radius(s), m);
    return;
  }
  ++added_;
  unbounded_ = true;
  log_slope_ = inf;
  const Profile profile(kernel_of(blend), dimension_of(s));
  low_ += least_field(s, profile, center_, rho_);
}

void SumBounds::add_inverse(const BlendField& blend) {
  const int n = blend.degree;
  const Vec3d& p = center_;
  constexpr auto all = Derivatives::Second;
  for (const auto& s : blend.points.skeletons)
    add(point_field<all>(s, p, n), distance_to(s, p), largest_radius(s), n - 1);
  for (const auto& s : blend.segments.skeletons)
    add_integral(blend, s, distance_to(s, p), n, [&] { return segment_field<all>(s, p, n); });
  for (const auto& s : blend.triangles.skeletons)
    add_integral(blend, s, distance_to(s, p), n + 1, [&] { return triangle_field<all>(s, p, n); });
  for (const auto& s : blend.arcs.skeletons)
    add_integral(blend, s, distance_to(s, p), n, [&] { return arc_field<all>(s, p, n); });
  add_cani_hornus(blend);
}

// (1 + s^2 d^2 / tau^2)^(-m/2) is an inverse power of the distance in four dimensions, tau / s being the fourth.
void SumBounds::add_cauchy(const BlendField& blend) {
  const Kernel kernel = kernel_of(blend);
  const Vec3d& p = center_;
  const auto lifted = [&](const auto& s) {
    const double d = distance_to(s, p), w = least_radius(s) / blend.kernel_shape;
    return std::sqrt(d * d + w * w);
  };
  constexpr auto all = Derivatives::Second;
  const int n = blend.degree;
  for (const auto& s : blend.points.skeletons) add(point_field<all>(s, p, kernel), lifted(s), largest_radius(s), n - 1);
  for (const auto& s : blend.segments.skeletons)
    add_integral(blend, s, lifted(s), n, [&] { return segment_field<all>(s, p, kernel); });
  for (const auto& s : blend.triangles.skeletons)
    add_integral(blend, s, lifted(s), n + 1, [&] { return triangle_field<all>(s, p, kernel); });
  for (const auto& s : blend.arcs.skeletons)
    add_integral(blend, s, lifted(s), n, [&] { return arc_field<all>(s, p, kernel); });
}

}  // namespace marrow
