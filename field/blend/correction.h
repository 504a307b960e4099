// The correction operator of the topology-controlled blend: from (f, G) to the corrected field.
#pragma once

#include <optional>

#include "field/description/field_node.h"
#include "field/kernel/inverse_family.h"

namespace marrow {

/// C(f, G) moves the point (f, G = |grad_S f|) along the direction -tan(alpha) onto the reference curve.
/// Isotone in f, G (and in alpha where G < g(f)) for alpha >= 0.
///   Projection::Paper  onto the chord of the curve: Zanni et al. 2015, eq. 12, in the stable form of field-maths 4.1;
///   Projection::Exact  onto the curve itself (field-maths 4.3); below alpha = 0 it is not defined and Paper is used.
///   cavity             points behind the critical point D of the curve M_d of two equal skeletons take the value
///                      of D (Zanni et al. 2015, sec. 4.2, with the sign of field-maths 5 step 2).
///   alpha < 0          the far-field pole is guarded (field-maths 4.4).
/// C(0, G) = 0, C(inf, G) = inf; alpha = pi/2 gives exactly f.
class Correction {
 public:
  /// degree in [min_kernel_degree, max_kernel_degree]; alpha in radians, in [-1, pi/2].
  Correction(int degree, double alpha, bool cavity, Projection);

  /// f >= 0, G >= 0; either may be infinite.
  double value(double f, double G) const;

  struct Partials {
    double value = 0;
    double df = 0;
    double dG = 0;  ///< may be infinite at G = 0 without cavity
    /// dC/dG / G, so that d(corrected) = df * grad f + dG_over_G * J^T grad_S f. Finite at G = 0 with cavity
    /// (there the corrected field is smooth); without, 0 is given at G = 0, where no derivative exists.
    double dG_over_G = 0;
    double dalpha = 0;  ///< 0 where C = f
  };
  Partials partials(double f, double G) const;

  /// Whether the cavity branch is taken at (f, G).
  bool in_cavity_branch(double f, double G) const;

  int degree() const { return curve_.degree(); }
  double alpha() const { return alpha_; }
  bool cavity() const { return cavity_; }
  Projection projection() const { return projection_; }
  bool is_sum() const { return is_sum_; }

 private:
  struct Slopes {
    double value, df, dG, dalpha;
  };
  /// The critical point D of the curve M_d of two equal skeletons 2 a apart, seen from a.   [field-maths 5]
  struct CriticalPoint {
    double eta;        ///< height / a
    double eta_slope;  ///< d eta / da
    double eta_by_alpha;
  };
  struct TwoSkeletons;

  // f and G inside (0, inf)
  double projected(double f, double G) const;
  Slopes projected_slopes(double f, double G) const;
  double projected_exactly(double f, double G, double x_H) const;
  std::optional<double> trivial(double f) const;
  std::optional<TwoSkeletons> behind_critical_point(double f, double G) const;
  CriticalPoint critical_point(double a) const;

  ReferenceCurve curve_;
  double alpha_;
  double sin_, cos_;
  bool cavity_, is_sum_;
  Projection projection_;
};

}  // namespace marrow
