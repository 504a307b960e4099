#include "field/blend/bounds/angle/mean_bounds.h"

#include <algorithm>
#include <limits>

namespace marrow {

MeanTerm product(const MeanTerm& a, const MeanTerm& b) {
  return {.weight = a.weight * b.weight,
          .slope = a.slope * b.weight.hi + a.weight.hi * b.slope,
          .bend = a.bend * b.weight.hi + 2 * a.slope * b.slope + a.weight.hi * b.bend};
}

// What is not known is infinite; where infinity meets 0, and makes no number, min() keeps what was there.
MeanChange mean_change(std::span<const MeanTerm> terms, double widest, double rho) {
  constexpr double inf = std::numeric_limits<double>::infinity(), roundings = 1e-9;
  MeanChange mean{inf, inf};
  double least = 0, slopes = 0;
  for (const MeanTerm& t : terms) {
    least += std::max(0.0, t.weight.lo);
    slopes += t.slope;
  }
  if (!(least > 0)) return mean;
  const double share = 1 / least * (1 + roundings);
  // How far values are from the mean depends on how far that moves: first anywhere, then as was found before.
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    const double moved = std::min(widest, mean.slope * rho);
    double slope = 0, bend = 0;
    for (const MeanTerm& t : terms) {
      const double apart = std::min(widest, t.apart + t.value_slope * rho + moved);
      slope += apart * t.slope + t.weight.hi * t.value_slope;
      bend += apart * t.bend + 2 * t.value_slope * t.slope + t.weight.hi * t.value_bend;
    }
    mean.slope = std::min(mean.slope, slope * share);
    mean.bend = std::min(mean.bend, (bend + 2 * mean.slope * slopes) * share);
  }
  return mean;
}

}  // namespace marrow
