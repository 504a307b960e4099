// The reference curve of the Cauchy and the compact kernel, which are finite on their skeletons.
#pragma once

#include "field/description/field_node.h"

namespace marrow {

/// The curve g on which every isolated infinite skeleton of such a kernel lies, |grad_S f| = g(f), over v in [0, 1]:
///   f = f_max v^p,   g = g_0 sqrt(1 - v) v^(e/2)
///   Cauchy   v = 1 / (1 + s^2 x^2),  p = (n-1)/2, e = n,   f_max = (1 + s^2)^p,     g_0 = (n-1) s f_max
///   compact  v = 1 - x^2 / R^2,      p = (n+1)/2, e = n-1, f_max = (1 - 1/R^2)^-p,  g_0 = (n+1) f_max / R
/// with x = distance / radius. g rises to its top at v* = e / (e+1) (s x = 1/sqrt n, x = R/sqrt n) and returns to 0 on
/// the skeleton, so that it has two branches. Only the outer one (f <= f*) tells a lone skeleton from a sum.
/// Here g goes on beyond f* at the height of its top: continuous, with a continuous slope, and never falling, which is
/// what a projection needs (Zanni et al. 2015 leave open what lies beyond).
/// Where f* is 1 but for rounding (R = sqrt n, s = 1/sqrt n) g levels off at f = 1 - 1e-10, so that what the operator
/// brings to the top is outside for certain.
/// By u = sqrt(v) all powers are whole: but for u itself, a root of f, nothing here is transcendental.
class BoundedCurve {
 public:
  /// Precondition: the family is not the inverse one, the shape is valid.
  explicit BoundedCurve(const Kernel&);

  double largest_field() const { return f_max_; }  ///< on the skeleton
  double top_field() const { return f_top_; }      ///< f*
  double top() const { return g_top_; }            ///< g(f*)
  double field_power() const { return 0.5 * k_; }  ///< p
  int twice_field_power() const { return k_; }     ///< 2p
  int height_power() const { return e_; }          ///< e
  double height_scale() const { return g_0_; }     ///< g_0

  /// A point of the continued curve g(f); u = sqrt(v), that of the top from there on.
  struct Place {
    double f, g, u;
  };
  /// f >= 0.
  Place place(double f) const;
  /// The first place of the height G: that with f = x_H; the top for all G above it.
  Place place_of_height(double G) const;
  /// g'.
  double slope(const Place&) const;
  /// Slope of the chord between two places, the first of them not beyond the top; without cancellation but near that.
  double chord_slope(const Place&, const Place&) const;

  double at(double f) const { return place(f).g; }
  /// |grad_S f| of a lone skeleton, on both branches: not continued.   Precondition: f <= largest_field().
  double alone_at(double f) const { return height_at(parameter(f)); }
  double slope(double f) const { return slope(place(f)); }
  /// x_H.
  double inverse(double G) const { return place_of_height(G).f; }
  /// The x with g(x) c + x s = height; c, s >= 0, not both 0. Where c = 1, s = 0 and the height is above the top: f*.
  double on_line(double c, double s, double height) const;

 private:
  double parameter(double f) const;
  double field_at(double u) const;
  double height_at(double u) const;

  int e_, k_;  // k = 2 p
  double f_max_, g_0_, u_top_, f_top_, g_top_;
};

}  // namespace marrow
