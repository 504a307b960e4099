// The field of one or of several skeletons as the weight of a mean; internal to blend/.
#pragma once

#include <optional>
#include <span>

#include "field/blend/bounds/angle/mean_bounds.h"
#include "field/blend/bounds/sum/sum_bounds.h"

namespace marrow {

inline constexpr double middle_is_off = 1e-9;  ///< roundings of what is known in the middle

/// ln f where f is above 0 and falls with powers of distances.
struct LogWeight {
  Vec3d slope{};    ///< in the middle
  double bend = 0;  ///< |D^2 ln f| in the ball, at most; infinite where nothing is known
};

/// In a ball of `rho` around the middle.
struct FieldWeight {
  double value = 0;  ///< in the middle
  Interval f{};
  double steepest = 0, bent = 0;  ///< |grad f| and |D^2 f| at most; not asked for where `log` is there
  std::optional<LogWeight> log{};

  /// Divided by e^(common . (p - middle)), for which `log` has to be known where `common` is not 0.
  MeanTerm term(const Vec3d& common, double rho) const;
};

/// Of an integral under kernels that fall with powers of distances, which is a sum of w |p - q|^-m: with d the least
/// distance anywhere in the ball |grad ln f| <= m / d, and D^2 ln f, which is the mean of those of the summands and the
/// variance of their grad ln, has a length of at most m / d^2 + m^2 / d^2 - |grad ln f|^2.
/// Of others as of the part.
FieldWeight weight_of(const SumBounds::Part&, double rho);
/// Of the sum of fields, from their terms without the common factor; `common` is the slope of the logarithm of the sum
/// in the middle. Of positive functions |D^2 ln sum w| is at most the mean of |D^2 ln w| + |grad ln w - common|^2.
LogWeight log_of_sum(const Vec3d& common, std::span<const MeanTerm>);
/// For which all of the skeleton counts that lies at different values.
MeanTerm term_of_all(const SumBounds::Part&);
/// Of a mean over the skeleton of values no farther from each other than `range`. Of an integral as above.
MeanChange mean_within(const SumBounds::Part&, double range, double rho);

}  // namespace marrow
