// The curve on which the corrected field of one angle is 1, as a table: "outside?" without evaluating the operator.
//
// C is the operator of blend/correction/correction.h [Zanni et al. 2015, sec. 4]. In the plane of x = f and
// y = |grad_S f| it is isotone in both for alpha >= 0 (../README.md), so {C < 1} is a region below one curve. It is
// stored in coordinates turned by theta = alpha, or a little more where alpha is near 0 or below it,
//   u = y sin theta - x cos theta,   v = x sin theta + y cos theta,
// because the operator projects along lines of constant v: C(x, y) < 1  <=>  v < V(u), with V nearly constant.
// For alpha < 0 C is isotone in y and first falls, then rises in x: the curve over x first rises, then falls, so that
// its minimum over an interval of x is at an end.
#pragma once

#include <vector>

#include "field/trace/curve/turned_curve.h"

namespace marrow {

class IsoTable {
 public:
  /// Needs a finite critical field. So many entries that C is off by no more than sums in float, but where its slope is
  /// not bounded (G = 0 without cavity). Where the curve comes to the border of the cavity branch it has a kink, and
  /// steps are so much shorter that an entry stands there: a line across it would be off by up to 2e-4, and C by up to
  /// 4e-5.
  /// `alpha` in radians, here and below.
  /// Where the curve does not end before, it goes on up to the G asked for, with more entries for more of it.
  IsoTable(const Correction&, double alpha, UpToGradient);
  /// An end of a range of angles, turned by alpha itself where that is not below 0: some `entry_count` entries, so
  /// coarser than the one above.
  IsoTable(const Correction&, double alpha, int entry_count);

  /// Piecewise linear over u in [u_begin, u_begin + (size - 1) / inverse_step]; entries as float, sorted by u.
  struct View {
    const float* value;  ///< V, nearest
    const float* lower;  ///< below V everywhere, between entries too
    const float* slope;  ///< V' at the entries, from the exact partials of C
    int size;
    float u_begin, inverse_step;
    float sin_theta, cos_theta;
    bool two_sided;      ///< alpha < 0: "outside" must be tested at both ends of the interval of x
    float peak_x;        ///< alpha < 0: where the curve over x is highest
    float critical;      ///< critical_field_of() the correction, rounded up
    float lower_beyond;  ///< V_lower from the last entry on
  };
  View view() const;

  /// Whether C < 1 for all 0 <= x in [x_low, x_high], 0 <= y <= y_high. Never wrongly true.
  bool outside(double x_low, double x_high, double y_high) const;
  /// Whether C > 1 for all x >= x_low, y >= y_low (for alpha < 0 only known beyond the critical field). Never wrongly
  /// true.
  bool inside(double x_low, double y_low) const;
  /// V_lower(u) - v: positive only where C < 1 for all smaller x, y (alpha >= 0), or at x, y itself.
  double margin(double x, double y) const;
  struct Point {
    double x, y;
  };
  /// On the curve, at an entry of the table.
  Point point(int entry) const;
  int size() const { return static_cast<int>(value_.size()); }
  /// critical_field_of() of the correction.
  double critical_field() const { return critical_; }
  /// Whether C falls in x somewhere (alpha < 0).
  bool two_sided() const { return two_sided_; }

 private:
  struct Entries {
    int fewest, most;
  };
  IsoTable(const Correction&, const TurnedCurve&, double alpha, Entries);
  double u_of(double x, double y) const { return y * sin_ - x * cos_; }
  double v_of(double x, double y) const { return x * sin_ + y * cos_; }
  double place(double u) const;
  bool is_beyond(double place) const;
  double beyond(const std::vector<float>& table) const;
  double lower(double u) const;
  double upper(double u) const;

  double critical_;
  double sin_ = 0, cos_ = 1, u_begin_ = 0, step_ = 1, peak_x_ = 0;
  bool two_sided_, ends_at_axis_;
  std::vector<float> value_, lower_, upper_, slope_;
};

}  // namespace marrow
