// The integral along a line under any kernel, as nodes of Gauss-Legendre panels; internal to skeleton/.
#pragma once

#include <cmath>

#include "field/kernel/panels.h"
#include "field/kernel/profile.h"
#include "field/skeleton/compact_rule.h"
#include "field/skeleton/reach.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// Adds weight k(d/tau) and its derivatives, v = p - q.
template <Derivatives Order>
void add_source(const Profile& profile, const Vec3d& v, double tau, double weight, SkeletonSample& sum) {
  const auto [value, slope, curvature] = profile.at(length_squared(v) / (tau * tau));
  const double k = 2 * weight * slope / tau;
  sum.value += weight * value;
  if constexpr (Order >= Derivatives::First) sum.gradient += v * (k / tau);
  sum.si_gradient += v * k;
  if constexpr (Order >= Derivatives::Second)
    sum.si_jacobian +=
        Matrix3::scaled_identity(k) + Matrix3::outer(v, v) * (4 * weight * curvature / (tau * tau * tau));
}

// tau^2 + s^2 (t^2 + h^2) = 0.
inline Singularity of_cauchy(const Line& line, double s) {
  const double lambda = line.slope * line.slope + s * s;
  return {-line.slope * line.at_foot / lambda,
          s * std::sqrt(line.at_foot * line.at_foot + lambda * line.h_squared) / lambda};
}

// Calls visit(t, dt) at the nodes of a rule for the Cauchy kernel.
template <class Visit>
void integrate_cauchy(const Line& line, const Kernel& kernel, const Visit& visit) {
  const Singularity pole = of_cauchy(line, kernel.shape);
  for_each_panel(line.t1, line.t2, {&pole, 1}, line.t2 - line.t1,
                 [&](const Panel& panel) { for_each_node(panel, line.slope == 0 ? 0 : kernel.degree, visit); });
}

/// Calls visit(t, |dE/dt|) where the edge of a compact support cuts the line.
template <class Visit>
void for_each_edge(const Line& line, double R, const Visit& visit) {
  const Reach<double> reach = reach_along(line, R);
  for (const auto& t : {reach.from, reach.to})
    if (t && *t > line.t1 && *t < line.t2) visit(*t, 2 * reach.half_rise);
}

// t^2 + h^2 = 0.
template <class Visit>
void integrate_inverse(const Line& line, const Kernel& kernel, const Visit& visit) {
  const Singularity pole{0, std::sqrt(line.h_squared)};
  for_each_panel(line.t1, line.t2, {&pole, 1}, line.t2 - line.t1,
                 [&](const Panel& panel) { for_each_node(panel, line.slope == 0 ? 0 : kernel.degree, visit); });
}

/// Calls visit(t, dt) such that sums of k(d/tau) times a polynomial of low degree are integrals along the line, to
/// 1e-13. `dimension`: of the skeleton that the line is of, 1 or 2, by which the power of the compact kernel goes
/// (Profile). Precondition: the point is not on the line under the inverse kernel.
template <class Visit>
void integrate_line(const Line& line, const Kernel& kernel, int dimension, const Visit& visit) {
  if (kernel.family == KernelFamily::Inverse) integrate_inverse(line, kernel, visit);
  else if (kernel.family == KernelFamily::Cauchy) integrate_cauchy(line, kernel, visit);
  else integrate_compact(line, kernel.shape, kernel.degree, kernel.degree + 1 - dimension, visit);
}

}  // namespace marrow
