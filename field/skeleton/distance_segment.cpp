// Field of the smallest scaled distance to a segment of linear radius.
#include <algorithm>
#include <cmath>

#include "field/kernel/inverse_family.h"
#include "field/math/elementary.h"
#include "field/skeleton/segment_place.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

// How the direction v/d from the nearest point turns, as its Jacobian. Inside a cone-like segment
// v/d = cos b h - sin b u with sin b = sigma e, so that turning is about the axis (1/h) and, because e changes
// along v/d, in the plane of axis and point.
Matrix3 direction_jacobian(const Vec3d& direction, const UnitVec3& u, double distance, double radius, double slope) {
  const double sin_b = slope * distance / radius;
  const double cos_b = std::sqrt(std::max(0.0, (1 - sin_b) * (1 + sin_b)));
  const Vec3d h = (direction + u * sin_b) / cos_b;
  const Vec3d tangent = h * sin_b + u * cos_b;
  const Vec3d around = cross(u.vec(), h);
  const double height = distance * cos_b;
  return Matrix3::outer(around, around) * (cos_b / height) +
         Matrix3::outer(tangent, direction) * (-slope / (cos_b * radius));
}

}  // namespace

template <Derivatives Order>
SkeletonSample distance_segment_field(const SegmentSkeleton& segment, const Vec3d& p, int n) {
  const double length = marrow::length(segment.to - segment.from);
  if (!(length > 0)) return {};
  const UnitVec3 u = UnitVec3::unchecked((segment.to - segment.from) / length);
  const SegmentPlace nearest = segment_place(segment, p, length, u.vec());
  const PointSkeleton point{{}, nearest.radius};
  if constexpr (Order >= Derivatives::Second) {
    SkeletonSample s = point_field<Order>(point, nearest.to_point, n);
    const double d = marrow::length(nearest.to_point);
    if (!nearest.is_inside || s.si_gradient == Vec3d{}) return s;
    // grad_S f = k'(e) v/d:  J = k''(e) v/d (grad e)^T + k'(e) J(v/d),  grad e = v/d / radius
    const Vec3d direction = nearest.to_point / d;
    const double slope = -marrow::length(s.si_gradient);       // k'(e)
    const double curvature = -n * slope * nearest.radius / d;  // k''(e) = n (n-1) e^-(n+1)
    const double sigma = (segment.radius_to - segment.radius_from) / length;
    s.si_jacobian = Matrix3::outer(direction, direction) * (curvature / nearest.radius) +
                    direction_jacobian(direction, u, d, nearest.radius, sigma) * slope;
    return s;
  } else {
    return point_field<Order>(point, nearest.to_point, n);
  }
}

template SkeletonSample distance_segment_field<Derivatives::ScaleInvariant>(const SegmentSkeleton&, const Vec3d&, int);
template SkeletonSample distance_segment_field<Derivatives::First>(const SegmentSkeleton&, const Vec3d&, int);
template SkeletonSample distance_segment_field<Derivatives::Second>(const SegmentSkeleton&, const Vec3d&, int);

}  // namespace marrow
