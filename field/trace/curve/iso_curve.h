// Where the corrected field is 1, in the plane of f and |grad_S f|, for one angle or for a range of them.
//
// At a given f and |grad_S f| the operator is monotone in alpha (../README.md): rising right of the reference curve,
// falling left of it. So over a range of angles it is largest, and least, at the ends of the range.
#pragma once

#include <vector>

#include "field/trace/curve/angle_tables.h"
#include "field/trace/curve/iso_table.h"

namespace marrow {

class IsoCurve {
 public:
  using View = IsoTable::View;

  /// For one angle, in radians, up to a G as iso_table.h says.
  IsoCurve(const Correction&, double alpha, UpToGradient);
  IsoCurve(const Correction&, double alpha);  ///< up to the usual one
  /// For all angles from `least` to `most`, -0.8 <= least < most (angle_tables.h), in radians, with the degree, cavity
  /// and projection of a correction.
  IsoCurve(const Correction&, double least, double most, UpToGradient);
  IsoCurve(const Correction&, double least, double most);  ///< up to the usual one

  IsoCurve(IsoCurve&&) = default;  // views stay where they are

  /// Whether C < 1 for all angles, 0 <= x in [x_low, x_high], 0 <= y <= y_high. Never wrongly true.
  bool outside(double x_low, double x_high, double y_high) const;
  /// Whether C > 1 for all angles, x >= x_low, y >= y_low (for alpha < 0 only known
  /// beyond the critical field). Never wrongly true.
  bool inside(double x_low, double y_low) const;
  /// The f from which on C(f, G) >= 1 for all angles and G.
  double critical_field() const { return ends_.front().critical_field(); }
  bool two_sided() const { return ends_.front().two_sided(); }

  /// Of the only angle, or the least.
  View view() const { return ends_.front().view(); }
  /// Of each angle of the range; none for one angle.
  AngleTables tables() const { return angles_.tables(); }
  double least() const { return least_; }
  double most() const { return most_; }

 private:
  double least_, most_;
  std::vector<IsoTable> ends_;  // of the range, or the only angle
  AngleCurves angles_;
};

}  // namespace marrow
