// Field of a segment of linear radius: its moments put together with directions.
#include "field/kernel/inverse_family.h"
#include "field/skeleton/moment_sample.h"
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
  const SkeletonSample s = sample_of<Order>(m, u, hv, n, 1 / curve_normalisation(n));
  return s.value <= field_ceiling ? s : SkeletonSample::on_skeleton();
}

template SkeletonSample segment_field<Derivatives::ScaleInvariant>(const SegmentSkeleton&, const Vec3d&, int);
template SkeletonSample segment_field<Derivatives::First>(const SegmentSkeleton&, const Vec3d&, int);
template SkeletonSample segment_field<Derivatives::Second>(const SegmentSkeleton&, const Vec3d&, int);

}  // namespace marrow
