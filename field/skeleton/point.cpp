// Field of a point.
#include <cmath>

#include "field/math/elementary.h"
#include "field/skeleton/skeletons.h"

namespace marrow {

template <Derivatives Order>
SkeletonSample point_field(const PointSkeleton& point, const Vec3d& p, int n) {
  const Vec3d v = p - point.at;
  const double d2 = length_squared(v), inverse = 1 / d2, ratio = point.radius * point.radius * inverse;
  SkeletonSample s;
  s.value = integer_power(ratio, (n - 1) / 2);
  if (n % 2 == 0) s.value *= std::sqrt(ratio);
  if (!(s.value <= field_ceiling)) return SkeletonSample::on_skeleton();
  const double slope = -(n - 1) * s.value * inverse;  // grad f = slope v
  if constexpr (Order >= Derivatives::First) s.gradient = v * slope;
  s.si_gradient = v * (slope * point.radius);
  if constexpr (Order >= Derivatives::Second) {
    s.si_jacobian =
        (Matrix3::scaled_identity(1) + Matrix3::outer(v, v) * (-(n + 1) * inverse)) * (slope * point.radius);
  }
  return s;
}

template SkeletonSample point_field<Derivatives::ScaleInvariant>(const PointSkeleton&, const Vec3d&, int);
template SkeletonSample point_field<Derivatives::First>(const PointSkeleton&, const Vec3d&, int);
template SkeletonSample point_field<Derivatives::Second>(const PointSkeleton&, const Vec3d&, int);

}  // namespace marrow
