// Points and segments under the Cauchy and the compact kernel; shares and Hessians of segments under any.
#include "field/skeleton/line_integral.h"
#include "field/skeleton/shares.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

// A segment as a line seen from p.
struct SeenLine {
  double length, foot;
  UnitVec3 along;
  Vec3d across;
  Line line;
};

SeenLine seen_from(const SegmentSkeleton& s, const Vec3d& p) {
  const double length = marrow::length(s.to - s.from);
  const UnitVec3 u = UnitVec3::unchecked((s.to - s.from) / length);
  const double foot = dot(p - s.from, u), slope = (s.radius_to - s.radius_from) / length;
  const Vec3d across = p - s.from - u * foot;
  return {length, foot, u, across, {-foot, length - foot, length_squared(across), s.radius_from + slope * foot, slope}};
}

// Where the inverse kernel is infinite.
bool is_on_line(const Line& line, const Kernel& kernel) {
  return kernel.family == KernelFamily::Inverse && line.h_squared == 0 && line.t1 <= 0 && line.t2 >= 0;
}

}  // namespace

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
  const Profile profile(kernel, 1);
  integrate_line(line, kernel, [&](double t, double weight) {
    const double tau = segment.radius_from + line.slope * (t + foot);
    add_source<Order>(profile, across - u * t, tau, weight / (profile.normalisation() * tau), sum);
  });
  return sum;
}

// Second derivatives of k(|v|^2 / tau^2): 2 k' / tau^2 I + 4 k'' / tau^4 v v^T.
Matrix3 segment_hessian(const SegmentSkeleton& segment, const Vec3d& p, const Kernel& kernel) {
  Matrix3 sum;
  if (segment.from == segment.to) return sum;
  const auto [length, foot, u, across, line] = seen_from(segment, p);
  if (is_on_line(line, kernel)) return sum;
  const Profile profile(kernel, 1);
  integrate_line(line, kernel, [&](double t, double weight) {
    const double tau = segment.radius_from + line.slope * (t + foot);
    SkeletonSample part;
    add_source<Derivatives::Second>(profile, across - u * t, tau, weight / (profile.normalisation() * tau), part);
    sum += part.si_jacobian * (1 / tau);
  });
  return sum;
}

ShareSample segment_share(const SegmentSkeleton& segment, const Vec3d& p, const Kernel& kernel) {
  ShareSample share;
  if (segment.from == segment.to) return share;
  const auto [length, foot, u, across, line] = seen_from(segment, p);
  if (is_on_line(line, kernel)) return share;
  const Profile profile(kernel, 1);
  integrate_line(line, kernel, [&](double t, double weight) {
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
