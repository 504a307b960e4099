// The curve of iso_table.h at even steps, and what straight lines between them are off by.
#pragma once

#include <optional>
#include <vector>

#include "field/trace/curve/turned_curve.h"

namespace marrow {

struct CurveEntries {
  double step = 1;
  std::vector<double> value{};           ///< V from the curve's beginning on
  std::vector<double> slope{};           ///< V', from the partials of the operator
  std::vector<double> below{}, above{};  ///< how far lines on both sides of an entry are from the curve, at most
  /// Lines on which C is off by more than sums in float are, 5e-7.
  int rough_steps = 0;
};

/// At least `entry_count`; with a kink the steps are so much shorter that an entry stands there.
CurveEntries curve_entries(const TurnedCurve&, int entry_count, std::optional<double> kink);

}  // namespace marrow
