#include "field/blend/log_weight.h"

#include <algorithm>
#include <cmath>

namespace marrow {

std::optional<IntegralWeight> weight_of(const SumBounds::Integral& integral, double rho) {
  const SkeletonSample& s = integral.sample;
  const double d = (integral.distance - rho) * (1 - middle_is_off), m = integral.m;
  if (!(d > 0 && std::isfinite(s.value))) return {};
  IntegralWeight weight{.log = {.value = s.value}, .distance = d, .m = m};
  if (!(s.value > 0)) return weight;
  weight.log.slope = s.gradient / s.value;
  const double most = m * (m + 1) / (d * d);
  const double least_slope = std::max(0.0, length(weight.log.slope) * (1 - middle_is_off) - most * rho);
  weight.log.bend = (most - std::min(least_slope * least_slope, m * m / (d * d))) * (1 + middle_is_off);
  return weight;
}

// The gradient is the covariance of values and grad ln w, the second derivative sum w (a - mean) D^2 w / w - 2 grad
// mean grad ln w.
MeanChange IntegralWeight::mean_of(double range) const {
  const double first = m / distance, second = first * (m + 1) / distance;
  return {0.5 * range * first, 0.5 * range * (second + 2 * first * first)};
}

}  // namespace marrow
