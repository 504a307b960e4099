// A table over the spread of radii from pairs of balls that touch, and one number from the torus.
#include "field/blend/angle/local_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "field/blend/angle/contact.h"
#include "field/blend/correction/correction.h"
#include "field/kernel/inverse_family.h"
#include "field/math/elementary.h"
#include "field/number/variables_at.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

constexpr int bisections = 50;

// That of the plain sum: between entries of the table the cubic may go beyond.
constexpr double most = std::numbers::pi / 2;

SkeletonSample field_of(const PointSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return kernel.family == KernelFamily::Inverse ? point_field<Derivatives::ScaleInvariant>(s, p, kernel.degree)
                                                : point_field<Derivatives::ScaleInvariant>(s, p, kernel);
}

// Two balls of radii 1 and `ratio` that touch.
struct TouchingPair {
  const Kernel& kernel;
  bool cavity;
  Projection projection;
  double contact, ratio;

  // C on the line of the centres, at u |u| from the point of touch in radii of the ball on that side: the valley is as
  // narrow as the smaller ball. The angle is `extra` above contact where f_1 = f_2, and falls off with the spread, that
  // is with 4 f_1 f_2 / f^2.
  double corrected(double u, double extra) const {
    const double at = u * std::fabs(u);
    const Vec3d p{at < 0 ? 1 + at : 1 + at * ratio, 0, 0};
    SkeletonSample sum = field_of({{0, 0, 0}, 1}, p, kernel);
    const SkeletonSample other = field_of({{1 + ratio, 0, 0}, ratio}, p, kernel);
    const double share = 4 * sum.value * other.value / ((sum.value + other.value) * (sum.value + other.value));
    sum += other;
    return Correction(kernel, contact + extra * share, cavity, projection).value(sum.value, length(sum.si_gradient));
  }

  // Scan, then ternary search: C has one valley between the balls.
  double least(double extra) const {
    constexpr int samples = 24;
    constexpr double reach = 0.8;
    double best = 0, value = corrected(0, extra);
    for (int i = -samples; i <= samples; ++i) {
      const double at = reach * i / samples, here = corrected(at, extra);
      if (here < value) {
        value = here;
        best = at;
      }
    }
    double low = best - reach / samples, high = best + reach / samples;
    for (int i = 0; i < 24; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (corrected(a, extra) < corrected(b, extra) ? high : low) = corrected(a, extra) < corrected(b, extra) ? b : a;
    }
    return std::min(value, corrected((low + high) / 2, extra));
  }

  double extra_angle() const {
    double low = 0, high = std::numbers::pi / 2 - contact;
    for (int i = 0; i < bisections; ++i) {
      const double middle = low + (high - low) / 2;
      (least(middle) < 1 ? low : high) = middle;
    }
    return high;
  }
};

}  // namespace

LocalContact::LocalContact(const Kernel& kernel, bool cavity, Projection projection, bool radii, bool density)
    : kernel_(kernel),
      cavity_(cavity),
      projection_(projection),
      radii_(radii),
      density_(density),
      contact_(contact_alpha(kernel, cavity, projection)),
      least_(contact_) {
  if (radii_) make_table();
  if (density_) fit_ring();
  constexpr double inf = std::numeric_limits<double>::infinity();
  range_ = within({0, inf}, {1, inf}).alpha;
}

void LocalContact::fit_ring() {
  const double in_ring = 2 * std::numbers::pi / curve_normalisation(kernel_.degree);
  double low = projection_ == Projection::Exact ? 0 : -1, high = contact_;
  for (int i = 0; i < bisections; ++i) {
    const double middle = low + (high - low) / 2;
    (Correction(kernel_, middle, cavity_, projection_).value(in_ring, 0) < 1 ? low : high) = middle;
  }
  least_ = high;
  const double beyond_pair = crowd_of_ring() - 2;
  dense_factor_ = (least_ - contact_) / (beyond_pair * beyond_pair);
}

// In the middle of a ring of radius 1 and thickness 1: f = 2 pi / N(n), the near field 2 pi / N(20).
double LocalContact::crowd_of_ring() const {
  return crowd_at(2 * std::numbers::pi / curve_normalisation(kernel_.degree),
                  2 * std::numbers::pi / curve_normalisation(near_degree));
}

void LocalContact::make_table() {
  for (std::size_t i = 1; i < entries; ++i) {
    const double y = step * static_cast<double>(i), spread = y / (1 - y);
    angle_[i] = TouchingPair{kernel_, cavity_, projection_, contact_, exp(-std::sqrt(spread))}.extra_angle();
  }
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = i + 1 == entries ? i : i + 1;
    slope_[i] = (angle_[after] - angle_[before]) / (step * static_cast<double>(after - before));
  }
  slope_[entries - 1] = 0;  // level beyond
}

LocalContact::Piece LocalContact::piece(std::size_t i) const {
  const double rise = angle_[i + 1] - angle_[i], first = slope_[i] * step, second = slope_[i + 1] * step;
  return {angle_[i], first, 3 * rise - 2 * first - second, first + second - 2 * rise};
}

// Cubic pieces over y, level beyond the last entry.
template <Number X>
X LocalContact::unequal(const X& spread) const {
  const X y = spread / (1 + spread);
  if (!(value_of(y) < last_y)) return X(angle_.back());
  const auto i = static_cast<std::size_t>(value_of(y) / step);
  const X t = y * (1 / step) - static_cast<double>(i);
  const auto [at, first, bend, twist] = piece(i);
  return at + t * (first + t * (bend + t * twist));
}

// In the variable y of the table. What lies between two knots is a cubic, inside the hull of its Bernstein
// coefficients, whose slope is inside that of their differences, and whose second derivative is linear.
LocalContact::Unequal LocalContact::unequal_within(const Interval& spread) const {
  const auto y_of = [](double s) { return s < 1e300 ? s / (1 + s) : 1; };
  const double begin = y_of(std::max(0.0, spread.lo)), end = y_of(std::max(0.0, spread.hi));
  if (begin >= last_y) return {angle_.back()};
  const auto sample = [&](double y) {
    Jet<double, 1> spread_here(y / (1 - y));
    spread_here.slope = {1};
    const Jet<double, 1> a = unequal(spread_here);
    return std::array{a.value, a.slope[0] / ((1 - y) * (1 - y))};  // d/dy = d/ds (1 + s)^2
  };
  Unequal all{Interval(sample(begin)[0])};
  if (end >= last_y) all.angle = hull(all.angle, angle_.back());
  for (double a = begin; a < std::min(end, last_y * (1 - 1e-12));) {
    const double index = std::floor(a / step + 1e-9);
    const double knot = step * (index + 1), b = std::min({knot, end, last_y * (1 - 1e-12)});
    const auto [at_a, slope_a] = sample(a);
    const auto [at_b, slope_b] = sample(b);
    const double third = (b - a) / 3, second = at_a + slope_a * third, fourth = at_b - slope_b * third;
    for (const double control : {at_a, second, fourth, at_b}) all.angle = hull(all.angle, control);
    for (const double slope : {slope_a, b > a ? (fourth - second) / third : 0, slope_b})
      all.steepest = std::max(all.steepest, std::fabs(slope));
    const Piece here = piece(static_cast<std::size_t>(index));
    for (const double y : {a, b})
      all.bent = std::max(all.bent, std::fabs(2 * here.bend + 6 * here.twist * (y / step - index)) / (step * step));
    if (b != knot) break;
    a = b;
  }
  // dy/ds = (1 - y)^2, d^2y/ds^2 = -2 (1 - y)^3; rounding, and that of the knots at which pieces begin
  const double left = 1 - begin, by_y = left * left;
  const double bent = all.bent * by_y * by_y + 2 * all.steepest * by_y * left;
  return {
      {all.angle.lo - 1e-9, all.angle.hi + 1e-9}, all.steepest * by_y * (1 + 1e-6) + 1e-9, bent * (1 + 1e-6) + 1e-9};
}

// Falls with the crowd beyond 2.
LocalContact::Within LocalContact::within(const Interval& spread, const Interval& crowd) const {
  Within all{contact_};
  if (radii_) {
    const Unequal unequal = unequal_within(spread);
    all.alpha += unequal.angle;
    all.by_spread = unequal.steepest;
    all.by_spread_twice = unequal.bent;
  }
  if (density_ && crowd.hi > 2) {
    all.by_crowd_twice = 2 * std::fabs(dense_factor_);
    all.by_crowd = all.by_crowd_twice * (crowd.hi - 2);
  }
  const auto dense = [&](double k) { return density_ && k > 2 ? dense_factor_ * (k - 2) * (k - 2) : 0; };
  const Interval alpha{all.alpha.lo + dense(crowd.hi) - 1e-12, all.alpha.hi + dense(crowd.lo) + 1e-12};
  const Interval allowed{density_ ? least_ : -most, most};
  all.may_be_cut = !(alpha.lo > allowed.lo && alpha.hi < allowed.hi);
  all.alpha = clamped(alpha, allowed);
  return all;
}

// crowd = (f e^(n-1))^((m-1)/(m-n)), e = near^(-1/(m-1)), m the near degree: k equal points give k.
template <Number X>
X LocalContact::crowd_at(const X& field, const X& near_field) const {
  const double share = crowd_share(), exponent = crowd_exponent();
  // below, quotients of the near field lose their digits; that far away C no longer depends on the angle
  constexpr double smallest_near_field = 1e-250;
  const double near = value_of(near_field);
  if (!(near > smallest_near_field && near <= field_ceiling && value_of(field) > 0)) return X(1.0);
  const double crowd = pow(value_of(field) * pow(near, -share), exponent);
  if constexpr (JetNumber<X>) {
    // relative to the values, as powers of very small fields leave the range of double
    const X more = log(field * (1 / value_of(field))) - log(near_field * (1 / near)) * share;
    return crowd * exp(more * exponent);
  } else {
    return crowd;
  }
}

double LocalContact::crowd(const Neighbourhood& place) const { return crowd_at(place.field, place.near_field); }

template <Number X>
X LocalContact::angle(const X& field, const X& spread, const X& near_field) const {
  X alpha(contact_);
  if (radii_) alpha += unequal(max(spread, X(0.0)));
  if (density_) {
    const X beyond_pair = crowd_at(field, near_field) - 2;
    if (value_of(beyond_pair) > 0) alpha += dense_factor_ * square(beyond_pair);
    if (!(value_of(alpha) > least_)) return X(least_);
  }
  return value_of(alpha) < most ? alpha : X(most);
}

AlphaSample LocalContact::at(const Neighbourhood& place) const {
  using X = Jet<double, 3>;
  const auto with = [](double value, const Vec3d& gradient) {
    X x(value);
    x.slope = {gradient.x, gradient.y, gradient.z};
    return x;
  };
  const X alpha = angle(with(place.field, place.field_gradient), with(place.spread, place.spread_gradient),
                        with(place.near_field, place.near_gradient));
  return {.value = alpha.value, .gradient = gradient_of(alpha)};
}

HessianJet LocalContact::at(const HessianJet& field, const HessianJet& spread, const HessianJet& near_field) const {
  return angle(field, spread, near_field);
}

}  // namespace marrow
