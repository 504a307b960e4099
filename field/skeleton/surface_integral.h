// The integrals over arcs and triangles under any kernel, as sums over nodes; internal to skeleton/.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "field/kernel/adaptive.h"
#include "field/math/turned_angle.h"
#include "field/skeleton/arc_view.h"
#include "field/skeleton/line_integral.h"
#include "field/skeleton/support_edge.h"
#include "field/skeleton/triangle_view.h"

namespace marrow {

/// Sum is a SkeletonSample, or derived from it with a += of its own.
namespace surface_integral {

// Of what has been gathered; halving gains some ten digits on a smooth panel, so that the true error is far below. The
// second derivatives of a compact kernel of degree 3 grow without end at the edge of its support, and peak where the
// edge all but touches a skeleton.
inline constexpr double tolerance = 1e-12, jacobian_tolerance = 1e-9;

inline bool agree(const SkeletonSample& coarse, const SkeletonSample& fine, const SkeletonSample& all) {
  const double size = length(all.si_gradient);
  double jacobian = 0, jacobians_differ = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    jacobian += length(all.si_jacobian.rows[i]);
    jacobians_differ += length(coarse.si_jacobian.rows[i] - fine.si_jacobian.rows[i]);
  }
  return std::fabs(coarse.value - fine.value) <= tolerance * all.value &&
         length(coarse.si_gradient - fine.si_gradient) <= tolerance * (size + all.value) &&
         jacobians_differ <= jacobian_tolerance * jacobian;
}

// The angle to either side within which an arc can be nearer than `reach`; pi for all, below 0 for none of it.
inline double angle_within(const ArcView& v, double reach) {
  const double rest = reach * reach - v.gap(), chord = 4 * v.r * v.major;
  if (rest < 0) return -1;
  return rest >= chord ? std::numbers::pi : 2 * asin(std::sqrt(rest / chord));
}

// Under the Cauchy kernel an integrand ends being smooth where tau^2 + s^2 d^2 = 0. With panels no longer than a
// quarter of the way on which the least radius could vanish, tau^2 stays above half its least square around them, so
// that the place is no nearer than for d^2 + tau^2 / (2 s^2) = 0 with the least tau.
struct CauchyPanels {
  double softening;  // tau^2 / (2 s^2)
  double longest;
};
inline CauchyPanels cauchy_panels(double least_radius, double slope, double s) {
  const double quarter = least_radius / (4 * std::fabs(slope));
  return {least_radius * least_radius / (2 * s * s), slope == 0 ? std::numeric_limits<double>::infinity() : quarter};
}

// Calls visit(angle, half, turn, weight, sum): the angle from the place nearest to the point, up to whole turns, and
// half of it.
template <class Sum, class Visit>
Sum integrate_cauchy_arc(const ArcView& v, const CauchyPanels& limits, const Visit& visit) {
  const double gap = v.gap() + limits.softening, turn = 2 * std::numbers::pi;
  const double eta =
      v.r > 0 ? 2 * asinh(std::sqrt(gap / (4 * v.r * v.major))) : std::numeric_limits<double>::infinity();
  const std::array<Singularity, 3> singularities{Singularity{-turn, eta}, Singularity{0, eta}, Singularity{turn, eta}};
  Sum sum;
  for_each_panel(v.begin, v.end, singularities, std::min(1.0, limits.longest), [&](const Panel& panel) {
    const TurnedAngle half((panel.begin + panel.length / 2) / 2);
    for_each_node(panel, max_kernel_degree,
                  [&](double angle, double weight) { visit(angle, half.at(angle / 2), 0, weight, sum); });
  });
  return sum;
}

// Within the reach of a compact kernel, from the nearest place outward, so that small angles keep their digits; that
// place may also be a turn away.
template <class Sum, class Visit>
Sum integrate_compact_arc(const ArcView& v, const ArcSkeleton& arc, double R, double within, const Visit& visit) {
  const double slope = (arc.radius_to - arc.radius_from) / (v.end - v.begin);
  Sum sum;
  for (const double turn : {-2 * std::numbers::pi, 0.0, 2 * std::numbers::pi})
    for (const double side : {-1.0, 1.0}) {
      const double first = side > 0 ? v.begin - turn : turn - v.end, last = side > 0 ? v.end - turn : turn - v.begin;
      const double near = std::max(0.0, first), far = std::min(within, last);
      if (!(near < far)) continue;
      const double tau = arc.radius_from + slope * (turn - v.begin);
      const auto visit_in = [&](double a, double b) {
        return [&, half = TurnedAngle((a + b) / 4)](double angle, double weight, Sum& part) {
          const auto [sine, cosine] = half.at(angle / 2);
          visit(side * angle, SinCos{side * sine, cosine}, turn, weight, part);
        };
      };
      sum += integrate_between<Sum>(edges_on_arc(v, tau, side * slope, R, near, far), visit_in, agree);
    }
  return sum;
}

// d^2 = z^2 + (r - major)^2 + 4 r major sin^2(angle / 2) vanishes at angle = +- i eta and whole turns away.
template <class Sum, class Visit>
Sum integrate_inverse_arc(const ArcView& v, const Visit& visit) {
  return integrate_cauchy_arc<Sum>(v, {.softening = 0, .longest = 1}, visit);
}

// How the radius changes from line to line.
inline double slope_across(const TriangleView& v) {
  const double along = (v.radius_end - v.radius_begin) / v.base;
  return std::fabs((v.radius_apex - v.radius_begin - along * v.apex_u) / v.apex_w) + std::fabs(along);
}

template <class Sum, class Visit>
Sum integrate_cauchy_lines(const TriangleView& v, const Kernel& kernel, const Visit& visit) {
  const double least = std::min({v.radius_begin, v.radius_end, v.radius_apex});
  const auto [softening, longest] = cauchy_panels(least, slope_across(v), kernel.shape);
  TriangleView lifted = v;
  lifted.p_normal = std::sqrt(v.p_normal * v.p_normal + softening);
  const std::array<Singularity, 3> singularities{Singularity{0, lifted.p_normal}, of_side(lifted, 0),
                                                 of_side(lifted, v.base)};
  Sum sum;
  for_each_panel(-v.p_w, v.apex_w - v.p_w, singularities, std::min(v.apex_w, longest), [&](const Panel& panel) {
    for_each_node(panel, kernel.degree, [&](double x, double weight) { visit(x, weight, sum); });
  });
  return sum;
}

template <class Sum, class Visit>
Sum integrate_compact_lines(const TriangleView& v, const Kernel& kernel, const Visit& visit) {
  const double reach = kernel.shape * std::max({v.radius_begin, v.radius_end, v.radius_apex});
  if (!(std::fabs(v.p_normal) < reach)) return {};
  const double width = std::sqrt((reach - v.p_normal) * (reach + v.p_normal));
  const double begin = std::max(-v.p_w, -width), end = std::min(v.apex_w - v.p_w, width);
  if (!(begin < end)) return {};
  const auto visit_in = [&](double, double) { return visit; };
  return integrate_between<Sum>(edges_on_lines(v, kernel.shape, begin, end), visit_in, agree);
}

template <class Sum, class Visit>
Sum integrate_inverse_lines(const TriangleView& v, const Kernel& kernel, const Visit& visit) {
  const std::array<Singularity, 3> singularities{Singularity{0, std::fabs(v.p_normal)}, of_side(v, 0),
                                                 of_side(v, v.base)};
  Sum sum;
  for_each_panel(-v.p_w, v.apex_w - v.p_w, singularities, v.apex_w, [&](const Panel& panel) {
    for_each_node(panel, kernel.degree, [&](double x, double weight) { visit(x, weight, sum); });
  });
  return sum;
}

}  // namespace surface_integral

/// The compact kernel w^(m/2) with m = 2 (triangles at degree 3) has a slope of -1/R^2 up to its edge and none beyond,
/// so that the integral of grad_S changes with p by what the moving edge takes in, too: grad_S there times -dt/dp = 2 v
/// / |dE/dt|. `weight`: of a node of the edge, over |dE/dt|.
inline void add_steep_edge(const Profile& profile, double R, const Vec3d& v, double tau, double weight,
                           SkeletonSample& sum) {
  sum.si_jacobian += Matrix3::outer(v, v) * (4 * weight / (R * R * profile.normalisation() * tau * tau * tau));
}

/// Calls visit(v, tau, share, weight, sum) with v from a node of the arc to p, tau its radius and share its place, 0 at
/// the begin and 1 at the end, and returns the sum.
/// Precondition: p is not on the arc under the inverse kernel.
template <class Sum, class Visit>
Sum integrate_arc(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel, const Visit& visit) {
  using namespace surface_integral;
  const ArcView v = view_from(arc, p);
  const double tau_slope = (arc.radius_to - arc.radius_from) / (v.end - v.begin);
  const auto at = [&](double angle, const SinCos& half, double turn, double weight, Sum& sum) {
    const double from_begin = angle + turn - v.begin, tau = arc.radius_from + tau_slope * from_begin;
    visit(v.from_arc(half), tau, from_begin / (v.end - v.begin), weight * arc.major, sum);
  };
  if (kernel.family == KernelFamily::Inverse) return integrate_inverse_arc<Sum>(v, at);
  if (kernel.family == KernelFamily::Cauchy)
    return integrate_cauchy_arc<Sum>(
        v, cauchy_panels(std::min(arc.radius_from, arc.radius_to), tau_slope, kernel.shape), at);
  const double within = angle_within(v, kernel.shape * std::max(arc.radius_from, arc.radius_to));
  return within < 0 ? Sum{} : integrate_compact_arc<Sum>(v, arc, kernel.shape, within, at);
}

/// The same over a triangle, and visit_edge(v, tau, weight, sum) for nodes along the edge of a compact support, with
/// weights over |dE/dt|, E = d^2 - R^2 tau^2 along the node's line.
/// Precondition: p is not on the triangle under the inverse kernel.
template <class Sum, class Visit, class VisitEdge>
Sum integrate_triangle(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel, const Visit& visit,
                       const VisitEdge& visit_edge) {
  using namespace surface_integral;
  bool foot_is_inside = false;
  const TriangleView v = best_view(triangle, p, foot_is_inside);
  if (!(v.apex_w > 0)) return {};
  const auto at = [&](double x, double weight, Sum& sum) {
    const SegmentView seen = line_at(v, x);
    const Line line{seen.t1, seen.t2, seen.h_squared, seen.radius_at_foot, seen.slope};
    if (!(line.t1 < line.t2)) return;
    const Vec3d across = v.normal * v.p_normal - v.w * x;
    const auto radius = [&](double t) { return seen.radius1 + seen.slope * (t - seen.t1); };
    integrate_line(line, kernel, 2, [&](double t, double dt) { visit(across - v.u * t, radius(t), weight * dt, sum); });
    if (kernel.family == KernelFamily::Compact)
      for_each_edge(line, kernel.shape, [&](double t, double steepness) {
        visit_edge(across - v.u * t, radius(t), weight / steepness, sum);
      });
  };
  if (kernel.family == KernelFamily::Inverse) return integrate_inverse_lines<Sum>(v, kernel, at);
  if (kernel.family == KernelFamily::Cauchy) return integrate_cauchy_lines<Sum>(v, kernel, at);
  return integrate_compact_lines<Sum>(v, kernel, at);
}
template <class Sum, class Visit>
Sum integrate_triangle(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel, const Visit& visit) {
  return integrate_triangle<Sum>(triangle, p, kernel, visit, [](const Vec3d&, double, double, Sum&) {});
}

}  // namespace marrow
