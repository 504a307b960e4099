// Points and segments under the Cauchy and the compact kernel; shares of segments under any.
#include "field/skeleton/compact_chord.h"
#include "field/skeleton/line_integral.h"
#include "field/skeleton/seen_line.h"
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
  const auto [length, foot, u, across, line] = seen_from(segment, p);
  if (kernel.family == KernelFamily::Compact && line.slope == 0) {
    CompactChords(kernel, 1).add<Order>(line, across, u, 1 / line.at_foot, sum);
    return sum;
  }
  const Profile profile(kernel, 1);
  integrate_line(line, kernel, 1, [&](double t, double weight) {
    const double tau = segment.radius_from + line.slope * (t + foot);
    add_source<Order>(profile, across - u * t, tau, weight / (profile.normalisation() * tau), sum);
  });
  return sum;
}

ShareSample segment_share(const SegmentSkeleton& segment, const Vec3d& p, const Kernel& kernel) {
  ShareSample share;
  if (segment.from == segment.to) return share;
  const auto [length, foot, u, across, line] = seen_from(segment, p);
  if (is_on_line(line, kernel)) return share;
  const Profile profile(kernel, 1);
  integrate_line(line, kernel, 1, [&](double t, double weight) {
    const double tau = segment.radius_from + line.slope * (t + foot);
    SkeletonSample part;
    add_source<Derivatives::First>(profile, across - u * t, tau, weight / (profile.normalisation() * tau), part);
    share.value += part.value * ((t + foot) / length);
    share.gradient += part.gradient * ((t + foot) / length);
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
