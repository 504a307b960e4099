// What segments of Cani and Hornus may change by: R(H)^2 times a positive sum of |p - q|^-3, H the foot of p, which
// moves no faster than p.   [Cani, Hornus 2001, sec. 4]
#include <algorithm>
#include <cmath>

#include "field/blend/bounds/sum/least_field.h"
#include "field/blend/bounds/sum/sum_bounds.h"
#include "field/skeleton/distance.h"
#include "field/skeleton/radii.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;
constexpr double sample_error = SumBounds::sample_error;

// In a ball of `rho` around a place at `distance` > rho.
class InBall {
 public:
  InBall(const SegmentSkeleton& s, const Vec3d& p, double distance, double rho)
      : distance_(distance), rho_(rho), q_(rho / distance) {
    const double size = length(s.to - s.from);
    u_ = (s.to - s.from) / size;
    slope_ = (s.radius_to - s.radius_from) / size;
    foot_ = {rounding::down(dot(p - s.from, u_) - rho, 8) / size, rounding::up(dot(p - s.from, u_) + rho, 8) / size};
    const double share = std::clamp(foot_.middle(), 0.0, 1.0);
    radius_ = s.radius_from + (s.radius_to - s.radius_from) * share;
    at_p_ = segment_field<Derivatives::Second>(SegmentSkeleton{s.from, s.to, radius_, radius_}, p, 3);
    const double least = least_radius(s), largest = largest_radius(s);
    wider_ = std::min(1 + std::fabs(slope_) * rho / least, largest / least) * (1 + 1e-9);
    radii_ = {radius_ / wider_, radius_ * wider_};
    log_slope_ = (3 / (distance - rho) + 2 * std::fabs(slope_) / least) * (1 + 1e-9);
  }

  bool is_finite() const { return std::isfinite(at_p_.value); }

  SumBounds::Between bounds() const {
    const Interval f = field();
    const double longest = 3 * radii_.hi * f.hi / (distance_ - rho_), by = S_change();
    const bool is_near = !(by < longest);
    return {.f = f,
            .S = is_near ? Vec3d{} : at_p_.si_gradient,
            .S_by = std::min(longest, by) * (1 + 1e-9),
            .log_slope = log_slope_};
  }

  // grad f = R^2 grad I + 2 f grad R / R, dS/dp = R^3 grad^2 I + 3 S grad R / R; beyond the ends R is constant.
  PrimitiveSlopes slopes() const {
    const Interval growth = radius_growth();
    const double by = change(at_p_.gradient, at_p_.value, 2), S_by = S_change(), J_by = J_change();
    const auto around = [](double x, double change) { return Interval(x) + Interval(-change, change); };
    PrimitiveSlopes b;
    for (std::size_t i = 0; i < 3; ++i) {
      b.gradient[i] = around(at_p_.gradient[i], by) + 2.0 * (field() * growth) * u_[i];
      const Interval S = around(at_p_.si_gradient[i], S_by);
      for (std::size_t j = 0; j < 3; ++j)
        b.J[i][j] = around(at_p_.si_jacobian.rows[i][j], J_by) + 3.0 * (S * growth) * u_[j];
    }
    return b;
  }

 private:
  Interval field() const {
    const double f = at_p_.value, wider = wider_ * wider_;
    return {f / (wider * integer_power(1 + q_, 3)), f * wider / integer_power(1 - q_, 3)};
  }

  // R' / R
  Interval radius_growth() const {
    if (foot_.hi <= 0 || foot_.lo >= 1 || slope_ == 0) return 0;
    const Interval inside = Interval(slope_) / radii_;
    return foot_.lo > 0 && foot_.hi < 1 ? inside : hull(inside, 0);
  }

  // Of R^k grad I, where R^k I is `size` at p, and |grad^2 I| <= 12 I / d^2.
  double change(const Vec3d& at_p, double size, int k) const {
    const double grown = integer_power(wider_, k);
    return (grown - 1) * length(at_p) + 12 * grown * size * rho_ / (integer_power(1 - q_, 5) * distance_ * distance_) +
           3 * sample_error * size / distance_;
  }
  double S_change() const { return change(at_p_.si_gradient, at_p_.value * radius_, 3); }

  // Of R^3 grad^2 I, and |grad^3 I| <= 60 I / d^3.
  double J_change() const {
    const double grown = integer_power(wider_, 3), unit = at_p_.value * radius_ / (distance_ * distance_);
    return unit * (12 * (grown - 1 + sample_error) + 60 * grown * q_ / integer_power(1 - q_, 6)) * (1 + 1e-9);
  }

  double distance_, rho_, q_, slope_ = 0, radius_ = 0, wider_ = 1, log_slope_ = 0;
  Vec3d u_;
  Interval foot_;   // over the length
  Interval radii_;  // at the feet
  SkeletonSample at_p_;
};

}  // namespace

void SumBounds::add_cani_hornus(const BlendField& blend) {
  for (const auto& s : blend.cani_hornus_segments.skeletons) {
    if (!(length(s.to - s.from) > 0)) {
      keep({.steepest = 0, .bent = 0});
      continue;
    }
    const double distance = distance_to(s, center_);
    const InBall ball(s, center_, distance, rho_);
    if (!(distance > rho_) || !ball.is_finite()) {
      const double least = std::min(s.radius_from, s.radius_to);
      const SegmentSkeleton even{s.from, s.to, least, least};
      const Interval f{least_field(even, Profile(kernel_of(blend), 1), center_, rho_), inf};
      add({.f = f, .S_by = inf, .log_slope = inf});
      keep({.f = f});
      continue;
    }
    Between b = ball.bounds();
    if (keeps_parts_)
      keep({.sample = cani_hornus_field<Derivatives::First>(s, center_), .f = b.f, .steepest = b.log_slope * b.f.hi});
    if (has_gradient()) b.slopes = ball.slopes();
    add(b);
  }
}

}  // namespace marrow
