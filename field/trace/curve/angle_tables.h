// Where the corrected field is 1 for each angle of a range: on each step of the range the curve of iso_table.h, in
// coordinates that are turned by one angle for the whole step, with entries that are quadratic in the angle.
#pragma once

#include <vector>

#include "field/trace/curve/turned_curve.h"

namespace marrow {

class Correction;

/// The share of the range is s + 1/2 steps beyond the beginning of its step, -1/2 <= s <= 1/2. What depends on s is
/// p[0] + s (p[1] + s p[2]).
struct AngleTables {
  /// p of V at the entries, and how far below V the curve may be there and up to the entries beside it.
  const float* entries = nullptr;
  const float* slopes = nullptr;  ///< p of V', from the exact partials of C, and 0
  /// Of each step; there are at least 32 numbers. The first entry is at u = begin.
  const float *begin[3] = {}, *inverse_step[3] = {};
  const float *sin_theta = nullptr, *cos_theta = nullptr;
  const float* last = nullptr;  ///< the number of its last entry
  /// Where over f the curves of a step are highest, between these two f; up to there they rise in f by at most so much.
  /// All 0 for angles from 0 on, whose curves fall.
  const float *crest_from = nullptr, *crest_to = nullptr, *rise = nullptr;
  int stride = 0, count = 0;  ///< entries from step to step; steps
};

class AngleCurves {
 public:
  AngleCurves() = default;
  /// -0.8 <= least < most, in radians: below, of degree 3, entries do not follow where the guard of the operator begins
  /// (README). Degree, cavity and projection are those of the correction. Up to a G, as iso_table.h says.
  AngleCurves(const Correction&, double least, double most, UpToGradient);
  AngleCurves(AngleCurves&&) = default;  // tables stay where they are
  AngleCurves& operator=(AngleCurves&&) = default;

  /// None where there is no range.
  AngleTables tables() const;

 private:
  std::vector<float> entries_, slopes_;
  std::vector<float> of_steps_[12];
  int stride_ = 0, count_ = 0;
};

}  // namespace marrow
