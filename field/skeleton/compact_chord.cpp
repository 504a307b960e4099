#include "field/skeleton/compact_chord.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "field/math/elementary.h"
#include "field/number/functions.h"
#include "field/skeleton/moment_sample.h"

namespace marrow {
namespace {

// The part of a line that is in the support.
struct Chord {
  double t1 = 0, t2 = 0;
  double rho2, l2;
  double beside1 = 0, beside2 = 0;  // sqrt(l^2 - t^2)

  Chord(const Line& line, double R) : rho2(square(R * line.at_foot)), l2(rho2 - line.h_squared) {
    if (!(l2 > 0)) return;
    const double l = std::sqrt(l2);
    t1 = std::max(line.t1, -l);
    t2 = std::min(line.t2, l);
    if (is_empty()) return;
    beside1 = std::sqrt((l - t1) * (l + t1));
    beside2 = std::sqrt((l - t2) * (l + t2));
  }
  bool is_empty() const { return !(t1 < t2); }
  // All but three digits at most.
  bool keeps_digits(int m) const {
    const double l = std::sqrt(l2), nearest = std::max({0.0, t1, -t2}) / l;
    return (t2 - t1) * half_power((1 - nearest) * (1 + nearest), m) > 0.002 * l;
  }
  // The angle between the ends, sin(angle) = t / l.
  double angle() const { return atan2(t2 * beside1 - t1 * beside2, beside1 * beside2 + t1 * t2); }
};

// Of w^(m/2), of t^j w^(m/2 - 1) and of t^j w^(m/2 - 2) along a chord; the last not for m = 2, where nothing asks.
struct ChordMoments {
  double value;
  std::array<double, 2> slope;
  std::array<double, 3> bend{};
};

ChordMoments moments_of(const Chord& c, int m) {
  const double w1 = square(c.beside1) / c.rho2, w2 = square(c.beside2) / c.rho2;
  const bool is_odd = m % 2 == 1;
  double integral = is_odd ? std::sqrt(c.rho2) * c.angle() : c.t2 - c.t1, lower = 0, lowest = 0;  // I(q) and before
  double power1 = is_odd ? std::sqrt(w1) : w1, power2 = is_odd ? std::sqrt(w2) : w2;              // w^(q+1)
  // [w^(q+1)] and before, from [w] by sums of one sign
  const double by = (c.t1 - c.t2) * (c.t1 + c.t2) / c.rho2;
  double next_rise = !is_odd ? by : by == 0 ? 0 : by / (power1 + power2), rise = 0, lower_rise = 0;
  for (int twice_q = is_odd ? -1 : 0; twice_q < m; twice_q += 2, power1 *= w1, power2 *= w2) {
    lowest = lower;
    lower = integral;
    lower_rise = rise;
    rise = next_rise;
    next_rise = w2 * rise + power1 * by;
    integral = (c.t2 * power2 - c.t1 * power1 + (twice_q + 2) * (c.l2 / c.rho2) * integral) / (twice_q + 3);
  }
  ChordMoments moments{.value = integral, .slope = {lower, -c.rho2 / m * rise}};
  if (m > 2) moments.bend = {lowest, -c.rho2 / (m - 2) * lower_rise, c.l2 * lowest - c.rho2 * lower};
  return moments;
}

}  // namespace

CompactChords::CompactChords(const Kernel& kernel, int dimension)
    : kernel_(kernel), profile_(kernel, dimension), dimension_(dimension) {}

template <Derivatives Order>
void CompactChords::add(const Line& line, const Vec3d& across, const UnitVec3& u, double weight,
                        SkeletonSample& sum) const {
  const double R = kernel_.shape, tau = line.at_foot;
  const int m = profile_.degree();
  const Chord chord(line, R);
  if (chord.is_empty()) return;
  weight /= profile_.normalisation();
  if (!chord.keeps_digits(m)) {
    integrate_line(line, kernel_, dimension_,
                   [&](double t, double dt) { add_source<Order>(profile_, across - u * t, tau, weight * dt, sum); });
    return;
  }
  const auto [value, slope, bend] = moments_of(chord, m);
  const double k = -m * weight / (R * R * tau);
  const Vec3d si = (across * slope[0] - u * slope[1]) * k;
  sum.value += weight * value;
  sum.si_gradient += si;
  if constexpr (Order >= Derivatives::First) sum.gradient += si / tau;
  if constexpr (Order >= Derivatives::Second)
    sum.si_jacobian += si_jacobian_of(k * slope[0], -(m - 2) / (R * R * tau * tau) * k, bend, u, across);
}

template void CompactChords::add<Derivatives::ScaleInvariant>(const Line&, const Vec3d&, const UnitVec3&, double,
                                                              SkeletonSample&) const;
template void CompactChords::add<Derivatives::First>(const Line&, const Vec3d&, const UnitVec3&, double,
                                                     SkeletonSample&) const;
template void CompactChords::add<Derivatives::Second>(const Line&, const Vec3d&, const UnitVec3&, double,
                                                      SkeletonSample&) const;

}  // namespace marrow
