// Field of an arc of linear radius by Gauss-Legendre panels over its angle.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "field/kernel/inverse_family.h"
#include "field/kernel/panels.h"
#include "field/math/elementary.h"
#include "field/math/turned_angle.h"
#include "field/skeleton/arc_view.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

// d^2 = z^2 + (r - major)^2 + 4 r major sin^2(angle / 2) vanishes at angle = +- i eta and whole turns away.
double singular_angle(const ArcView& v, double major) {
  return v.r > 0 ? 2 * asinh(std::sqrt(v.gap() / (4 * v.r * major))) : std::numeric_limits<double>::infinity();
}

// tau^(n-1) d^-n
double kernel_of(double tau, double inverse_square, int n) {
  const double ratio = tau * tau * inverse_square;
  return n % 2 == 0 ? integer_power(ratio, (n - 2) / 2) * (tau * inverse_square)
                    : integer_power(ratio, (n - 1) / 2) * std::sqrt(inverse_square);
}

}  // namespace

template <Derivatives Order>
SkeletonSample arc_field(const ArcSkeleton& arc, const Vec3d& p, int n) {
  const ArcView v = view_from(arc, p);
  const double eta = singular_angle(v, arc.major), turn = 2 * std::numbers::pi;
  const std::array<Singularity, 3> singularities{Singularity{-turn, eta}, Singularity{0, eta}, Singularity{turn, eta}};
  if (distance_to(singularities, v.begin, v.end) == 0) return SkeletonSample::on_skeleton();
  const double tau_slope = (arc.radius_to - arc.radius_from) / (v.end - v.begin);
  const double scale = arc.major / curve_normalisation(n), gap = v.gap();
  SkeletonSample sum;
  // Within a radian the cosine is as good as a parabola to a rule of 20 nodes.
  for_each_panel(v.begin, v.end, singularities, 1, [&](const Panel& panel) {
    const TurnedAngle half((panel.begin + panel.length / 2) / 2);
    for_each_node(panel, max_kernel_degree, [&](double angle, double weight) {
      const auto [sine, cosine] = half.at(angle / 2);
      const double sag = 2 * arc.major * sine * sine;  // major (1 - cos angle)
      const double inverse = 1 / (gap + 2 * v.r * sag), tau = arc.radius_from + tau_slope * (angle - v.begin);
      const Vec3d from_arc =
          v.radial * (v.r - arc.major + sag) - v.tangential * (2 * arc.major * sine * cosine) + v.normal * v.z;
      const double value = scale * weight * kernel_of(tau, inverse, n), slope = -n * value * inverse;
      sum.value += value;
      if constexpr (Order >= Derivatives::First) sum.gradient += from_arc * slope;
      sum.si_gradient += from_arc * (slope * tau);
      if constexpr (Order >= Derivatives::Second)
        sum.si_jacobian +=
            (Matrix3::scaled_identity(1) + Matrix3::outer(from_arc, from_arc) * (-(n + 2) * inverse)) * (slope * tau);
    });
  });
  return sum.value <= field_ceiling ? sum : SkeletonSample::on_skeleton();
}

template SkeletonSample arc_field<Derivatives::ScaleInvariant>(const ArcSkeleton&, const Vec3d&, int);
template SkeletonSample arc_field<Derivatives::First>(const ArcSkeleton&, const Vec3d&, int);
template SkeletonSample arc_field<Derivatives::Second>(const ArcSkeleton&, const Vec3d&, int);

}  // namespace marrow
