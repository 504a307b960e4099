// The integral along a line under any kernel, as nodes of Gauss-Legendre panels; internal to skeleton/.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "field/kernel/inverse_family.h"
#include "field/kernel/panels.h"
#include "field/kernel/profile.h"
#include "field/math/elementary.h"
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

/// A segment from the foot of the point: radius tau(t) = at_foot + slope t over [t1, t2], the point at height h.
struct Line {
  double t1, t2, h_squared, at_foot, slope;
};

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

// How long a panel may be over which powers of the cosine are integrated: up to the 16th the rule of 20 nodes does for
// half a turn in two panels (6e-16), up to the 24th for one of length 1. Of a kernel of degree n the power is n + 1 at
// most, and derivatives and dt add four.
inline double longest_panel(const Kernel& kernel) { return kernel.degree + 5 <= 16 ? 1.6 : 1; }

// Where the kernel reaches: A t^2 + 2 B t + C < 0 with A = 1 - R^2 slope^2.
// A > 0: between two roots. With t = middle + half sin(angle) half powers of the quadratic are powers of the cosine.
template <class Visit>
void between_roots(const Line& line, double middle, double half, double longest, const Visit& visit) {
  const auto angle_of = [&](double t) { return asin(std::clamp((t - middle) / half, -1.0, 1.0)); };
  std::array<Singularity, 1> pole{Singularity{0, std::numeric_limits<double>::infinity()}};
  if (line.slope != 0) {
    const double at = (-line.at_foot / line.slope - middle) / half;  // radius 0, outside the support
    pole[0] = {std::copysign(std::numbers::pi / 2, at), acosh(std::max(1.0, std::fabs(at)))};
  }
  for_each_panel(angle_of(line.t1), angle_of(line.t2), pole, longest, [&](const Panel& panel) {
    for_each_node(panel, max_kernel_degree, [&](double angle, double weight) {
      const auto [sine, cosine] = sincos(angle);
      visit(middle + half * sine, weight * half * cosine);
    });
  });
}

// The same of an even degree: there the kernel is a polynomial over a power of the radius, so that rules go along t.
template <class Visit>
void between_roots_evenly(const Line& line, double middle, double half, int degree, const Visit& visit) {
  const double begin = std::max(line.t1, middle - half), length = std::min(line.t2, middle + half) - begin;
  if (!(length > 0)) return;
  const auto at = [&](double from_begin, double weight) { visit(begin + from_begin, weight); };
  if (line.slope == 0) {
    for_each_polynomial_node(length, degree + 1, at);  // one for shares
    return;
  }
  const Singularity pole{-line.at_foot / line.slope - begin, 0};
  for_each_panel(0, length, {&pole, 1}, length, [&](const Panel& panel) { for_each_node(panel, degree, at); });
}

// A <= 0: from a root on, where the radius grows. With t = root + direction w^2 half powers are powers of w.
template <class Visit>
void beyond_root(const Line& line, double root, const Visit& visit) {
  const double direction = line.slope > 0 ? 1 : -1;
  const double near = direction > 0 ? line.t1 : line.t2, far = direction > 0 ? line.t2 : line.t1;
  const auto w_of = [&](double t) { return std::sqrt(std::max(0.0, direction * (t - root))); };
  const Singularity pole{0, std::sqrt(std::fabs(root + line.at_foot / line.slope))};
  for_each_panel(w_of(near), w_of(far), {&pole, 1}, w_of(far), [&](const Panel& panel) {
    for_each_node(panel, max_kernel_degree,
                  [&](double w, double weight) { visit(root + direction * w * w, 2 * weight * w); });
  });
}

template <class Visit>
void integrate_compact(const Line& line, const Kernel& kernel, int dimension, const Visit& visit) {
  const double R2 = kernel.shape * kernel.shape;
  const double A = 1 - R2 * line.slope * line.slope, B = -R2 * line.slope * line.at_foot;
  const double C = line.h_squared - R2 * line.at_foot * line.at_foot, discriminant = B * B - A * C;
  if (A > 0) {
    if (!(discriminant > 0)) return;
    const double middle = -B / A, half = std::sqrt(discriminant) / A;
    const int degree = kernel.degree + 1 - dimension;  // of Profile
    if (degree % 2 == 0) between_roots_evenly(line, middle, half, degree, visit);
    else between_roots(line, middle, half, longest_panel(kernel), visit);
    return;
  }
  // The root on the side of positive radii, in the form without cancellation: C / (-B -+ sqrt).
  const double root_of = std::sqrt(std::max(0.0, discriminant)), q = -B - std::copysign(root_of, B);
  const double first = q == 0 ? 0 : C / q, second = A == 0 ? first : q / A;
  const double root = line.at_foot + line.slope * first >= line.at_foot + line.slope * second ? first : second;
  beyond_root(line, root, visit);
}

/// Calls visit(t, |dE/dt|) where the edge of a compact support cuts the line: E = d^2 - R^2 tau^2 = A t^2 + 2 B t + C.
template <class Visit>
void for_each_edge(const Line& line, double R, const Visit& visit) {
  const double R2 = R * R, A = 1 - R2 * line.slope * line.slope, B = -R2 * line.slope * line.at_foot;
  const double C = line.h_squared - R2 * line.at_foot * line.at_foot, discriminant = B * B - A * C;
  if (!(discriminant > 0)) return;
  const double root_of = std::sqrt(discriminant), q = -B - std::copysign(root_of, B);
  for (const double t : {C / q, q / A})
    if (t > line.t1 && t < line.t2 && line.at_foot + line.slope * t > 0) visit(t, 2 * root_of);
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
  else integrate_compact(line, kernel, dimension, visit);
}

}  // namespace marrow
