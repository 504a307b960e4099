#include "field/blend/bounds/angle/field_weight.h"

#include <algorithm>
#include <cmath>

#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;
// Beyond this nothing is worth knowing.
constexpr double largest_change = 6;

// e^x for x >= 0, or a little more: what its series leaves out behind x^2 is less than x^3/6 sum (x/4)^k.
double growth(double x) { return x < 1 ? 1 + x * (1 + x * (0.5 + x / (6 - 1.5 * x))) : exp(x); }

double nearest(const SumBounds::Part& part, double rho) { return (part.distance - rho) * (1 - middle_is_off); }

}  // namespace

MeanTerm FieldWeight::term(const Vec3d& common, double rho) const {
  if (!log) return {.weight = f, .slope = steepest, .bend = bent};
  const double steep = length(log->slope - common) * (1 + middle_is_off) + log->bend * rho;
  if (!(steep * rho < largest_change)) return {.weight = {0, inf}, .slope = inf, .bend = inf};
  const double grows = growth(steep * rho) * (1 + middle_is_off), most = value * grows;
  return {.weight = {value / grows, most}, .slope = most * steep, .bend = most * (steep * steep + log->bend)};
}

FieldWeight weight_of(const SumBounds::Part& part, double rho) {
  const SkeletonSample& s = part.sample;
  if (part.distance == 0) {
    FieldWeight weight{.value = s.value, .f = part.f, .steepest = part.steepest, .bent = part.bent};
    if (part.bent < inf)
      weight.steepest = std::min(part.steepest, length(s.gradient) + middle_is_off * part.steepest + part.bent * rho);
    return weight;
  }
  const double d = nearest(part, rho), m = part.m;
  if (!(d > 0 && s.value > 0 && std::isfinite(s.value)))
    return {.value = s.value, .f = {0, inf}, .steepest = inf, .bent = inf};
  const Vec3d slope = s.gradient / s.value;
  const double most = m * (m + 1) / (d * d);
  const double least_slope = std::max(0.0, length(slope) * (1 - middle_is_off) - most * rho);
  FieldWeight weight{.value = s.value};
  weight.log = {slope, (most - std::min(least_slope * least_slope, m * m / (d * d))) * (1 + middle_is_off)};
  return weight;
}

LogWeight log_of_sum(const Vec3d& common, std::span<const MeanTerm> terms) {
  double least = 0, bend = 0;
  for (const MeanTerm& t : terms) {
    least += t.weight.lo;
    bend += t.bend;
  }
  return {common, least > 0 ? bend / least * (1 + middle_is_off) : inf};
}

MeanTerm term_of_all(const SumBounds::Part& part) {
  return {.weight = part.f, .slope = part.steepest, .bend = part.bent};
}

// The gradient is the covariance of values and grad ln w, the second derivative sum w (a - mean) D^2 w / w - 2 grad
// mean grad ln w.
MeanChange mean_within(const SumBounds::Part& part, double range, double rho) {
  if (range == 0) return {};
  const double d = nearest(part, rho);
  if (!(part.distance > 0 && d > 0)) return {inf, inf};
  const double first = part.m / d, second = first * (part.m + 1) / d;
  return {0.5 * range * first, 0.5 * range * (second + 2 * first * first)};
}

}  // namespace marrow
