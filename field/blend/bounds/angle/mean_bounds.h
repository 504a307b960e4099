// How fast a weighted mean changes in space, from how fast its weights and values do; internal to blend/.
#pragma once

#include <span>

#include "field/number/interval.h"

namespace marrow {

/// One term of a mean sum w v / sum w whose weights are not negative and vary in space, as its values may, about the
/// middle of a ball. Values are numbers or vectors; of derivatives what counts are their largest lengths in the ball.
/// All weights of a mean may be given times one factor e^(-c . (p - middle)), which changes nothing of the mean.
struct MeanTerm {
  Interval weight;
  double slope;            ///< |grad w|
  double bend;             ///< |D^2 w|
  double apart = 0;        ///< |v - mean| in the middle
  double value_slope = 0;  ///< |grad v|
  double value_bend = 0;   ///< |D^2 v|
};

/// The product of two weights; values are left at 0.
MeanTerm product(const MeanTerm&, const MeanTerm&);

/// The largest lengths of first and second derivatives in the ball; infinite where nothing is known.
struct MeanChange {
  double slope = 0, bend = 0;
};
/// Of the mean m. `widest` is as far as any value comes from the mean anywhere in the ball, `rho` its radius. With
/// F = sum w:
///   F grad m = sum ((v - m) grad w + w grad v),
///   F D^2 m = sum ((v - m) D^2 w + grad v grad w^T + grad w grad v^T + w D^2 v) - grad m grad F^T - grad F grad m^T.
MeanChange mean_change(std::span<const MeanTerm>, double widest, double rho);

}  // namespace marrow
