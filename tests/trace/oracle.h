// Roots along rays by an independent way: exact fields in double, certified steps, no tables, blocks or polynomials.
#pragma once

#include <optional>

#include "field/blend/blend_field.h"
#include "field/math/ray.h"

namespace marrow::test {

/// Steps are certified by second-order bounds of f and grad_S f (taylor_remainder.h) from exact values at one
/// point, with the moments M2 <= f / d^2 and M3 <= K / d, where K comes from the trace of the Jacobian. For
/// alpha < 0 it relies on C having its largest value over an interval of f at an end.
class Oracle {
 public:
  explicit Oracle(const BlendField&);

  /// The first t in the ray's interval with a corrected field of 1 or more. Stretches shorter than 1e-6 of the distance
  /// to the skeleton may be overlooked.
  std::optional<double> first_root(const Ray&) const;
  /// The largest (corrected field - 1) on [t0, t1], by samples that grow denser towards t0 as a geometric series.
  double largest_excess(const Ray&, double t0, double t1) const;
  /// The largest (1 - corrected field) on [t0, t1], by the same samples and by evenly spaced ones.
  double largest_deficit(const Ray&, double t0, double t1) const;

  double value(const Vec3d& p) const;
  /// To the nearest skeleton: the radius there, as long as p is on the surface of one skeleton.
  double skeleton_distance(const Vec3d& p) const;
  /// How far p is from the surface over the distance to the skeleton, to first order.
  double displacement(const Vec3d& p) const;

 private:
  struct Local;
  Local local(const Vec3d& p, const Vec3d& direction) const;
  double corrected(const Local&) const;
  bool outside(const Local&, double step) const;
  double certified_step(const Local&, double limit, double& share) const;

  Correction correction_with(double alpha) const;

  const BlendField& blend_;
  Correction correction_;
  double least_ = 0, most_ = 0, steepness_ = 1;  // of angles, where they vary
};

}  // namespace marrow::test
