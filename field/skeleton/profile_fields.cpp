// Points and segments under the Cauchy and the compact kernel; shares of segments under any.
#include "field/skeleton/compact_chord.h"
#include "field/skeleton/segment_integral.h"
#include "field/skeleton/shares.h"
#include "field/skeleton/skeletons.h"

namespace marrow {

template <Derivatives Order>
SkeletonSample point_field(const PointSkeleton& point, const Vec3d& p, const Kernel& kernel) {
  const Profile profile(kernel, 0);
  SkeletonSample s;
  add_source<Order>(profile, p - point.at, point.radius, 1 / profile.normalisation(), s);
  return s;
}

template <Derivatives Order>
SkeletonSample segment_field(const SegmentSkeleton& segment, const Vec3d& p, const Kernel& kernel) {
  SkeletonSample sum;
  if (segment.from == segment.to) return sum;
  const SeenLine seen = seen_from(segment, p);
  if (kernel.family == KernelFamily::Compact && seen.line.slope == 0) {
    CompactChords(kernel, 1).add<Order>(seen.line, seen.across, seen.along, 1 / seen.line.at_foot, sum);
    return sum;
  }
  const Profile profile(kernel, 1);
  integrate_segment(segment, seen, kernel, profile,
                    [&](const SegmentNode& node) { add_source<Order>(profile, node.v, node.tau, node.weight, sum); });
  return sum;
}

ShareSample segment_share(const SegmentSkeleton& segment, const Vec3d& p, const Kernel& kernel) {
  ShareSample share;
  if (segment.from == segment.to) return share;
  const SeenLine seen = seen_from(segment, p);
  if (is_on_line(seen.line, kernel)) return share;
  const Profile profile(kernel, 1);
  integrate_segment(segment, seen, kernel, profile, [&](const SegmentNode& node) {
    SkeletonSample part;
    add_source<Derivatives::First>(profile, node.v, node.tau, node.weight, part);
    share.value += part.value * node.share;
    share.gradient += part.gradient * node.share;
  });
  return share;
}

template SkeletonSample point_field<Derivatives::ScaleInvariant>(const PointSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample point_field<Derivatives::First>(const PointSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample point_field<Derivatives::Second>(const PointSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample segment_field<Derivatives::ScaleInvariant>(const SegmentSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample segment_field<Derivatives::First>(const SegmentSkeleton&, const Vec3d&, const Kernel&);
template SkeletonSample segment_field<Derivatives::Second>(const SegmentSkeleton&, const Vec3d&, const Kernel&);

}  // namespace marrow
