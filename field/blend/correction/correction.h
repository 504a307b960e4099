// The correction operator of the topology-controlled blend: from (f, G) to the corrected field.
#pragma once

#include <optional>

#include "field/blend/correction/bounded_correction.h"
#include "field/blend/correction/correction_partials.h"
#include "field/description/field_node.h"
#include "field/kernel/inverse_family.h"

namespace marrow {

/// C(f, G) moves the point (f, G = |grad_S f|) along the direction -tan(alpha) onto the reference curve.
/// Isotone in f, G (and in alpha where G < g(f)) for alpha >= 0.
///   Projection::Paper  onto the chord of the curve: Zanni et al. 2015, eq. 12, as a weighted mean (correction.cpp);
///   Projection::Exact  onto the curve itself; below alpha = 0 it is not defined and Paper is used.
///   cavity             points behind the critical point D of the curve M_d of two equal skeletons take the value
///                      of D (Zanni et al. 2015, sec. 4.2, with the slope -tan(alpha) in step 2).
///   alpha < 0          far away, where eq. 12 has a pole, it is 2 x_H - f with g(x_H) = G, and 0 at least.
/// C(0, G) = 0, C(inf, G) = inf; alpha = pi/2 gives exactly f.
/// Under the Cauchy and the compact kernel: as of BoundedCorrection.
class Correction {
 public:
  /// Inverse kernel; degree in [min_kernel_degree, max_kernel_degree]; alpha in radians, in [-1, pi/2].
  Correction(int degree, double alpha, bool cavity, Projection);
  /// Any kernel; alpha in [0, pi/2] but for the inverse one.
  Correction(const Kernel&, double alpha, bool cavity, Projection);

  /// f >= 0, G >= 0; either may be infinite.
  double value(double f, double G) const;

  using Partials = CorrectionPartials;
  Partials partials(double f, double G) const;

  /// The critical point D of the curve M_d of two equal skeletons 2 a apart, from a.   [Zanni et al. 2015, sec. 4.2]
  struct CriticalPoint {
    double eta;        ///< height / a
    double eta_slope;  ///< d eta / da
    double eta_by_alpha;
    bool is_steepest = false;  ///< alpha < 0 and M_d is nowhere so steep: its steepest point instead
  };
  /// Of the inverse kernel; a > 0.
  CriticalPoint critical_point(double a) const;

  /// Whether the cavity branch is taken at (f, G).
  bool in_cavity_branch(double f, double G) const;

  int degree() const { return curve_.degree(); }
  double alpha() const { return alpha_; }
  bool cavity() const { return cavity_; }
  Projection projection() const { return projection_; }
  bool is_sum() const { return is_sum_; }
  /// Whether C(f, G) = f for every G: pi/2, and where powers of f leave the range of double.
  bool is_trivial(double f) const { return trivial(f).has_value(); }
  /// Of a kernel that is finite on its skeletons; else nothing.
  const std::optional<BoundedCorrection>& bounded() const { return bounded_; }

 private:
  struct TwoSkeletons;

  // f and G inside (0, inf)
  double projected(double f, double G) const;
  ProjectedSlopes projected_slopes(double f, double G) const;
  double projected_exactly(double f, double G, double x_H) const;
  std::optional<double> trivial(double f) const;
  std::optional<TwoSkeletons> behind_critical_point(double f, double G) const;

  ReferenceCurve curve_;
  double alpha_;
  double sin_, cos_;
  bool cavity_, is_sum_;
  Projection projection_;
  std::optional<BoundedCorrection> bounded_;
};

}  // namespace marrow
