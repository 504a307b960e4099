// The curve on which the corrected field of one angle is 1, in the turned coordinates of iso_table.h.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

namespace marrow {

class Correction;
struct CorrectionPartials;

/// The f with C(f, 0) = 1; infinite when there is none.
double critical_field_of(const Correction&);

/// Six times the G of the reference curve at the iso-value: fields of skeletons as long as a tenth of their radius do
/// not come to more (largest_gradient.h).
double usual_gradient(const Correction&);

/// The turn for all angles from `least` on, about `middle`: that one, but no less than 0.3. Where G is nearly 0 and
/// alpha near 0 or below, the curve runs along the axis of G, and over x alone it would begin as steeply as a root.
/// Below 0, where it may rise in x by up to 6, its tangent may not turn far: 0.1.
double turn_for(double least, double middle);

/// The G up to which a curve is wanted.
struct UpToGradient {
  double largest;
};

/// Points of the quarter plane x, y >= 0 on the line of given u.
struct TurnedLine {
  double u, sin_theta, cos_theta;

  /// The operator is 0 at f = 0 by definition; the curve is that of its limit.
  static constexpr double least_x = 1e-9;

  double x(double v) const { return std::max(least_x, v * sin_theta - u * cos_theta); }
  double y(double v) const { return std::max(0.0, u * sin_theta + v * cos_theta); }
  double first_v() const;
};

/// V(u) from where the curve meets the axis G = 0 on.
class TurnedCurve {
 public:
  /// Turned by `turn`, 0 to pi/2 radians, up to a G. The correction must outlive the curve; its
  /// critical field must be finite.
  TurnedCurve(const Correction&, double critical_field, double turn, UpToGradient);

  double sine() const { return sin_; }
  double cosine() const { return cos_; }
  double begin() const { return begin_; }  ///< the u of the axis G = 0
  double end() const { return end_; }
  /// Whether it ends where it nears the axis x = 0; else it goes on.
  bool ends_at_axis() const { return ends_at_axis_; }
  /// The u where it comes to the border of the cavity branch, if it does.
  std::optional<double> kink() const;
  /// V(u), from the axis x = 0 on that axis.
  double value(double u) const;
  struct Place {
    double v;
    double slope;   ///< V'; not finite where partial derivatives do not tell it
    double growth;  ///< dC/dv
  };
  /// The same, and how curve and operator go on there: by Newton's steps from a guess, to a rounding.
  Place place(double u, double guess) const;
  /// How far v is above the curve, or below where negative, by how C grows along v at two places around it; by V(u)
  /// where these differ by more than a third or C is not near 1.
  double height(double u, double v, const std::array<double, 2>& growth) const;
  TurnedLine line_of(double u) const { return {u, sin_, cos_}; }

 private:
  double excess(double u, double v) const;
  CorrectionPartials partials(double u, double v) const;
  Place told_by(const CorrectionPartials&, double v) const;
  double root(double u) const;

  const Correction& correction_;
  double sin_, cos_, begin_, end_;
  bool ends_at_axis_;
};

/// The guess of V one step behind two places that are as far apart: by the cubic through both and their slopes.
inline double value_behind(const TurnedCurve::Place& before, const TurnedCurve::Place& last, double step) {
  return 5 * before.v - 4 * last.v + step * (2 * before.slope + 4 * last.slope);
}

}  // namespace marrow
