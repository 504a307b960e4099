// Field of a segment of linear radius: its moments put together with directions.
#include "field/kernel/inverse_family.h"
#include "field/kernel/segment_moments.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

struct SegmentFrame {
  UnitVec3 along;
  Vec3d across;  // from the foot on the line to the point
  SegmentView view;
};

// Measured from the nearer end, so that the components of a short vector are split, not of a long one.
SegmentFrame frame_of(const SegmentSkeleton& segment, const Vec3d& p, double length) {
  SegmentFrame frame{UnitVec3::unchecked((segment.to - segment.from) / length), {}, {}};
  const Vec3d from_first = p - segment.from, from_second = p - segment.to;
  SegmentView& view = frame.view;
  if (dot(from_first, frame.along) <= length / 2) {
    const double foot = dot(from_first, frame.along);
    frame.across = from_first - frame.along * foot;
    view.t1 = -foot;
    view.t2 = length - foot;
  } else {
    const double foot = dot(from_second, frame.along);
    frame.across = from_second - frame.along * foot;
    view.t2 = -foot;
    view.t1 = -foot - length;
  }
  view.h_squared = length_squared(frame.across);
  view.slope = (segment.radius_to - segment.radius_from) / length;
  view.radius1 = segment.radius_from;
  view.radius_at_foot = segment.radius_from - view.slope * view.t1;
  return frame;
}

}  // namespace

template <Derivatives Order>
SkeletonSample segment_field(const SegmentSkeleton& segment, const Vec3d& p, int n) {
  const double length = marrow::length(segment.to - segment.from);
  if (!(length > 0)) return {};
  const auto [u, hv, view] = frame_of(segment, p, length);
  if (view.h_squared == 0 && view.t1 <= 0 && view.t2 >= 0) return SkeletonSample::on_skeleton();
  const SegmentMoments m = segment_moments<Order>(view, n);
  const double scale = 1 / curve_normalisation(n), slope = -n * scale;
  SkeletonSample s;
  s.value = scale * m.value;
  if (!(s.value <= field_ceiling)) return SkeletonSample::on_skeleton();
  if constexpr (Order >= Derivatives::First) s.gradient = (hv * m.first[0] - u * m.first[1]) * slope;
  s.si_gradient = (hv * m.si[0] - u * m.si[1]) * slope;
  if constexpr (Order >= Derivatives::Second) {
    // slope (I si_0 - (n+2) sum of q q^T weights, q = hv - t u), the outer product split at its left factor
    const double k = -(n + 2) * slope;
    s.si_jacobian = Matrix3::scaled_identity(slope * m.si[0]) +
                    Matrix3::outer(hv, hv * (k * m.second[0]) - u * (k * m.second[1])) +
                    Matrix3::outer(u, u * (k * m.second[2]) - hv * (k * m.second[1]));
  }
  return s;
}

template SkeletonSample segment_field<Derivatives::ScaleInvariant>(const SegmentSkeleton&, const Vec3d&, int);
template SkeletonSample segment_field<Derivatives::First>(const SegmentSkeleton&, const Vec3d&, int);
template SkeletonSample segment_field<Derivatives::Second>(const SegmentSkeleton&, const Vec3d&, int);

}  // namespace marrow
