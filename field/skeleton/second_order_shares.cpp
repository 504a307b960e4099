// Second derivatives of the shares of nodes and of the directions of arcs.
#include <cstddef>

#include "field/kernel/profile.h"
#include "field/skeleton/compact_line.h"
#include "field/skeleton/corners.h"
#include "field/skeleton/differences.h"
#include "field/skeleton/on_skeleton.h"
#include "field/skeleton/second_order.h"
#include "field/skeleton/second_order_source.h"
#include "field/skeleton/segment_integral.h"
#include "field/skeleton/shares.h"
#include "field/skeleton/surface_integral.h"

namespace marrow {
namespace {

using X = HessianJet;

// The surface integrals are made for samples.
struct Sum : SkeletonSample {
  SecondOrderShares shares{};
  Vec3<X> direction{};
  Sum& operator+=(const Sum& b) {
    SkeletonSample::operator+=(b);
    for (std::size_t k = 0; k < shares.size(); ++k) shares[k] += b.shares[k];
    direction += b.direction;
    return *this;
  }
};

X share_of_end(const SegmentSkeleton& segment, const Vec3d& p, const Kernel& kernel) {
  X share;
  if (segment.from == segment.to) return share;
  if (kernel.family == KernelFamily::Compact) return compact_line(segment, p, kernel, true).field;
  const SeenLine seen = seen_from(segment, p);
  if (is_on_line(seen.line, kernel)) return share;
  const Profile profile(kernel, 1);
  integrate_segment(segment, seen, kernel, profile, [&](const SegmentNode& node) {
    share += second_order_source(profile, node.v, node.tau, node.weight * node.share).field;
  });
  return share;
}

// Under the compact kernel: its first share as the field of a sample, its direction as the other field.
SecondOrderSample compact_along(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  const auto plain = [&](const ArcSkeleton& seen, const Vec3d& q) {
    const ShareSample share = integral_shares(seen, q, kernel)[0];
    const DirectionSample direction = arc_direction(seen, q, kernel);
    return SkeletonSample{share.value, share.gradient, direction.value, direction.jacobian};
  };
  return by_differences(arc, p, plain);
}

Sum along(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  if (is_on(arc, p, kernel)) return {};
  const Profile profile(kernel, 1);
  const Vec3d axis = cross(arc.axis1, arc.axis2), from_center = p - arc.center;
  return integrate_arc<Sum>(arc, p, kernel, [&](const Vec3d& v, double tau, double share, double weight, Sum& sum) {
    const double part = weight / (profile.normalisation() * tau);
    const X field = second_order_source(profile, v, tau, part).field;
    const Vec3d tangent = cross(axis, from_center - v) / arc.major;
    sum.shares[0] += field * share;
    sum.direction += Vec3<X>{field * tangent.x, field * tangent.y, field * tangent.z};
  });
}

// Under the compact kernel: both shares as the field and a component of the other field of a sample.
SecondOrderShares compact_shares(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel) {
  const auto plain = [&](const TriangleSkeleton& seen, const Vec3d& q) {
    const Shares shares = integral_shares(seen, q, kernel);
    SkeletonSample sample{shares[0].value, shares[0].gradient, {shares[1].value, 0, 0}, {}};
    sample.si_jacobian.rows[0] = shares[1].gradient;
    return sample;
  };
  const SecondOrderSample found = by_differences(triangle, p, plain);
  return {found.field, found.si.x};
}

}  // namespace

SecondOrderShares second_order_shares(const PointSkeleton&, const Vec3d&, const Kernel&) { return {}; }
SecondOrderShares second_order_shares(const SegmentSkeleton& segment, const Vec3d& p, const Kernel& kernel) {
  return {share_of_end(segment, p, kernel), X()};
}
SecondOrderShares second_order_shares(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  if (kernel.family == KernelFamily::Compact) return {compact_along(arc, p, kernel).field, X()};
  return along(arc, p, kernel).shares;
}
SecondOrderShares second_order_shares(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel) {
  if (kernel.family == KernelFamily::Compact) return compact_shares(triangle, p, kernel);
  if (is_on(triangle, p, kernel)) return {};
  const Profile profile(kernel, 2);
  const Corners corners(triangle);
  const Vec3d from_corner = p - triangle.vertices[0];
  return integrate_triangle<Sum>(triangle, p, kernel,
                                 [&](const Vec3d& v, double tau, double weight, Sum& sum) {
                                   const double part = weight / (profile.normalisation() * tau * tau);
                                   const X field = second_order_source(profile, v, tau, part).field;
                                   for (std::size_t k = 0; k < 2; ++k)
                                     sum.shares[k] += field * dot(from_corner - v, corners.dual[k]);
                                 })
      .shares;
}

SecondOrderShares second_order_foot_shares(const SegmentSkeleton& s, const Vec3d& p) {
  const Vec3d along = s.to - s.from;
  return {clamp(dot(variables_at<HessianJet>(p) - s.from, along / length_squared(along)), 0, 1), X()};
}

Vec3<X> second_order_direction(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  if (kernel.family == KernelFamily::Compact) return compact_along(arc, p, kernel).si;
  return along(arc, p, kernel).direction;
}

}  // namespace marrow
