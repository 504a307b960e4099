// The segment of Cani and Hornus: the constant-radius integral of 1/r^3 with the radius at the foot of the point.
#include <algorithm>

#include "field/skeleton/skeletons.h"

namespace marrow {

// f = R(H)^2 I(p), with R moving along with the foot H while it is inside: two more terms than a constant radius has.
template <Derivatives Order>
SkeletonSample cani_hornus_field(const SegmentSkeleton& s, const Vec3d& p) {
  constexpr int n = 3;
  const double length = marrow::length(s.to - s.from);
  if (!(length > 0)) return {};
  const Vec3d u = (s.to - s.from) / length;
  const double foot = dot(p - s.from, u), share = std::clamp(foot / length, 0.0, 1.0);
  const double radius = s.radius_from + (s.radius_to - s.radius_from) * share;
  SkeletonSample sample = segment_field<Order>(SegmentSkeleton{s.from, s.to, radius, radius}, p, n);
  if (!(sample.value <= field_ceiling) || !(foot > 0 && foot < length)) return sample;
  const Vec3d log_slope = u * ((s.radius_to - s.radius_from) / (length * radius));  // grad R / R
  if constexpr (Order >= Derivatives::First) sample.gradient += log_slope * (2 * sample.value);
  // grad_S f = R^3 grad I
  if constexpr (Order >= Derivatives::Second) sample.si_jacobian += Matrix3::outer(sample.si_gradient, log_slope * 3.0);
  return sample;
}

template SkeletonSample cani_hornus_field<Derivatives::ScaleInvariant>(const SegmentSkeleton&, const Vec3d&);
template SkeletonSample cani_hornus_field<Derivatives::First>(const SegmentSkeleton&, const Vec3d&);
template SkeletonSample cani_hornus_field<Derivatives::Second>(const SegmentSkeleton&, const Vec3d&);

}  // namespace marrow
