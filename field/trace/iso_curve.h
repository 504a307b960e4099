// Where the corrected field is 1, in the plane of f and |grad_S f|, for one angle or for a range of them.
//
// At a given f and |grad_S f| the operator is monotone in alpha (tracing.md 3.3): rising right of the reference curve,
// falling left of it. So over a range of angles it is largest, and least, at the ends of the range.
#pragma once

#include <span>
#include <vector>

#include "field/trace/angle_tables.h"
#include "field/trace/iso_table.h"

namespace marrow {

class IsoCurve {
 public:
  using View = IsoTable::View;

  /// For one angle, in radians.
  IsoCurve(const Correction&, double alpha);
  /// Of a range of angles: what gives the angle of a place.
  enum class Range { Skeletons, Directions };
  /// For all angles from `least` to `most`, 0 <= least < most, in radians, with the degree, cavity and projection of a
  /// correction. Where skeletons have angles: tables for angles at equal distances, cubic between them. What that is
  /// off is found half way between tables, and V_lower lies below V by twice as much. Where directions give them: for
  /// both ends.
  IsoCurve(const Correction&, double least, double most, Range = Range::Skeletons);

  IsoCurve(IsoCurve&&) = default;  // views stay where they are

  /// Whether C < 1 for all angles, 0 <= x in [x_low, x_high], 0 <= y <= y_high. Never wrongly true.
  bool outside(double x_low, double x_high, double y_high) const;
  /// Whether C > 1 for all angles, x >= x_low, y >= y_low (for alpha < 0 only known
  /// beyond the critical field). Never wrongly true.
  bool inside(double x_low, double y_low) const;
  /// The f from which on C(f, G) >= 1 for all angles and G.
  double critical_field() const { return rows_.front().critical_field(); }
  bool two_sided() const { return rows_.front().two_sided(); }

  /// V_lower(u) - v for the angle least + share (most - least), `share` in [0, 1]: in double what the kernels read
  /// from views(). Of one angle, or where skeletons have angles.
  double margin(double x, double y, double share = 0) const;

  /// Of the only table, or the first.
  View view() const { return views_.front(); }
  /// Of all tables: from the least angle to the largest.
  std::span<const View> views() const { return views_; }
  /// Of the range; none for one angle.
  AngleTables tables() const { return angles_.tables(); }
  double least() const { return least_; }
  double most() const { return most_; }

 private:
  struct Place;
  void add_rows(const Correction&);

  double least_, most_;
  std::vector<IsoTable> rows_;
  std::vector<View> views_;
  AngleCurves angles_;
};

}  // namespace marrow
