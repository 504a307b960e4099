// How fast the logarithm of a field changes in a ball; internal to blend/.
#pragma once

#include <optional>

#include "field/blend/mean_bounds.h"
#include "field/blend/sum_bounds.h"

namespace marrow {

inline constexpr double middle_is_off = 1e-9;  ///< roundings of what is known in the middle

/// The field f of a skeleton or of several, above 0.
struct LogWeight {
  double value = 0;  ///< f in the middle
  Vec3d slope{};     ///< of ln f in the middle
  double bend = 0;   ///< |D^2 ln f| in the ball, at most

  /// As the weight of a mean whose weights all have the factor that belongs to this slope.
  MeanTerm term(const Vec3d& common, double rho) const {
    return {.weight = value, .slope = length(slope - common) * (1 + middle_is_off) + bend * rho, .bend = bend};
  }
};

/// Of an integral, which is a sum of w |p - q|^-m over its skeleton. With d the least distance anywhere in the ball
/// |grad ln f| <= m / d, and D^2 ln f, which is the mean of those of the summands and the variance of their grad ln,
/// has a length of at most m / d^2 + m^2 / d^2 - |grad ln f|^2.   [tracing 3.1]
struct IntegralWeight {
  LogWeight log;
  double distance, m;

  /// Of a mean over the skeleton of values no farther from each other than `range`.
  MeanChange mean_of(double range) const;
};
/// Within rho of the middle. Nothing where the skeleton may be met.
std::optional<IntegralWeight> weight_of(const SumBounds::Integral&, double rho);

}  // namespace marrow
