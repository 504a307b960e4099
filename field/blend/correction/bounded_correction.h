// The correction operator for kernels that are finite on their skeletons: Cauchy and compact.
#pragma once

#include <optional>

#include "field/blend/correction/correction_partials.h"
#include "field/description/field_node.h"
#include "field/kernel/bounded_curve.h"

namespace marrow {

/// C(f, G) as of Correction, with the curve of BoundedCurve: the outer branch, continued level beyond its top (f*, g*).
///
/// Where it holds
///   - C is continuous, and isotone in f and in G, for all alpha in [0, pi/2]. C <= max(f, f*).
///   - A lone infinite skeleton (or point) keeps its field where f <= f*: its surface, if f* >= 1, that is
///     s >= 1/sqrt n, R <= sqrt n. (With cavity, compact: f <= 0.85 f*.)
///   - Beyond f* the operator goes on: two touching skeletons have f = 2 between them, which may exceed f*. The field
///     next to a skeleton is then lowered too, and it stays solid if C(f_max, 0) > 1: solid_alone().
///   - Two equal skeletons join exactly when they touch for contact_alpha() of the kernel, if it exists: if even
///     alpha = 0 joins them before they touch, see there.
///   - alpha < 0 is not defined (where the level part begins the line misses the curve).
/// Projection::Paper moves to the chord (eq. 12) for points below the curve; above it, where the chord of a concave
/// curve is not isotone, and under Projection::Exact everywhere, to the curve. C is continuously differentiable across
/// the curve.
///
/// Cavity: two equal skeletons 2a apart have f = 2 k(r), G = 2 h |k'(r)| / r at height h over the middle, r^2 =
/// a^2 + h^2. With B = a^2 + 1/s^2 (Cauchy) or B = R^2 - a^2 (compact) their curve M is steepest as -tan(alpha) where
///   cos(alpha) (B - n h^2) = sin(alpha) h (B +- h^2),        + Cauchy, - compact;
/// for 1/s = 0 this is the cubic of the inverse kernel (as of Correction). k is analytic in r^2, and all is used for
/// r^2 < 0 and a^2 < 0 too (f above twice the largest field of one skeleton), so that nothing switches there.
class BoundedCorrection {
 public:
  /// The family is Cauchy or compact; alpha in [0, pi/2].
  BoundedCorrection(const Kernel&, double alpha, bool cavity, Projection);

  double value(double f, double G) const;
  /// The place whose projection C is: (f, G) itself, or in the cavity branch the critical point before it. As alpha
  /// grows that point comes nearer: its f rises, its G falls.
  struct Place {
    double f, G;
  };
  Place projected_from(double f, double G) const;
  /// One of two equal unit skeletons that have (f, G) together, at a place of M.
  struct Pair {
    double w;    ///< r^2 + 1/s^2 (Cauchy) or R^2 - r^2 (compact)
    double psi;  ///< |k'(r)| / r = 2 p k / w
    double h;    ///< height over the middle
    double B;    ///< w -+ h^2
  };
  Pair pair_at(double f, double G) const;
  /// The w at the surface of a unit skeleton: k = (w / w_1)^(-+p).
  double unit_w() const { return w_1_; }
  /// h of the critical point: rises with B, falls with alpha; h^2 <= B / n.
  double critical_height(double B) const;
  /// C without the cavity branch; monotone in alpha.
  double projected(const Place&) const;
  CorrectionPartials partials(double f, double G) const;
  bool in_cavity_branch(double f, double G) const;
  /// Whether C > 1 all the way from the surface of a lone point to its middle.
  bool solid_alone() const;

  const BoundedCurve& curve() const { return curve_; }
  const Kernel& kernel() const { return kernel_; }

 private:
  struct TwoSkeletons;
  // From (f, G) horizontally to the curve, and the weighted mean of both ends.
  struct Chord {
    BoundedCurve::Place end;
    double slope, weight, sum, value;

    Chord(const BoundedCorrection&, const BoundedCurve::Place&, double G);
  };

  bool is_on_chord(const BoundedCurve::Place&, double G) const;
  double projected(const BoundedCurve::Place&, double G) const;
  ProjectedSlopes projected_slopes(double f, double G) const;
  double steepness(double h, double B) const;
  std::optional<TwoSkeletons> behind_critical_point(double f, double G) const;

  Kernel kernel_;
  BoundedCurve curve_;
  double w_1_, sin_, cos_;
  bool cavity_;
  Projection projection_;
};

}  // namespace marrow
