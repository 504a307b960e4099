// How fast a weighted mean changes in space, from how fast its weights and values do; internal to blend/.
#pragma once

#include <span>

namespace marrow {

/// One term of a mean sum w v / sum w whose weights are above 0 and vary in space, as its values may, about the middle
/// of a ball. Values are numbers or vectors; of derivatives what counts are their largest lengths anywhere in the ball.
struct MeanTerm {
  double weight;           ///< in the middle, at any scale that all terms share
  double slope;            ///< of |grad ln w - c|, for one vector c that all terms share
  double bend;             ///< of |D^2 ln w|
  double apart = 0;        ///< |v - mean| in the middle
  double value_slope = 0;  ///< of |grad v|
  double value_bend = 0;   ///< of |D^2 v|
};

/// The largest lengths of first and second derivatives in the ball; infinite where nothing is known.
struct MeanChange {
  double slope = 0, bend = 0;
};
/// Of the mean. `widest` is as far as any value comes from the mean anywhere in the ball, `rho` its radius.
/// With p = w / sum w and l = grad ln w - c:
///   grad mean = sum p ((v - mean) l + grad v),
///   D^2 mean = sum p ((l - sum p l) ((v - mean) l + grad v) + (grad v - grad mean) l + (v - mean) D^2 ln w + D^2 v).
MeanChange mean_change(std::span<const MeanTerm>, double widest, double rho);

/// Of |D^2 ln sum w| = |sum p (D^2 ln w + l l^T) - (sum p l) (sum p l)^T|.
double log_bend(std::span<const MeanTerm>, double rho);

}  // namespace marrow
