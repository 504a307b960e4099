// Second derivatives of integrals: those of the kernel, summed over the nodes of the same quadratures.
#include "field/skeleton/second_order.h"

#include <cstddef>

#include "field/skeleton/compact_line.h"
#include "field/skeleton/differences.h"
#include "field/skeleton/on_skeleton.h"
#include "field/skeleton/second_order_source.h"
#include "field/skeleton/segment_integral.h"
#include "field/skeleton/skeletons.h"
#include "field/skeleton/surface_integral.h"

namespace marrow {
namespace {

// The surface integrals are made for samples.
struct Sum : SkeletonSample {
  SecondOrderSample second;
  Sum& operator+=(const Sum& b) {
    SkeletonSample::operator+=(b);
    second += b.second;
    return *this;
  }
};

SecondOrderSample limited(const SecondOrderSample& s) {
  return s.field.value <= field_ceiling ? s : SecondOrderSample::on_skeleton();
}

}  // namespace

SecondOrderSample second_order(const PointSkeleton& point, const Vec3d& p, const Kernel& kernel) {
  const Profile profile(kernel, 0);
  if (kernel.family == KernelFamily::Inverse && p == point.at) return SecondOrderSample::on_skeleton();
  return limited(second_order_source(profile, p - point.at, point.radius, 1 / profile.normalisation()));
}

SecondOrderSample second_order(const SegmentSkeleton& segment, const Vec3d& p, const Kernel& kernel) {
  SecondOrderSample sum;
  if (segment.from == segment.to) return sum;
  if (kernel.family == KernelFamily::Compact) return compact_line(segment, p, kernel);
  const SeenLine seen = seen_from(segment, p);
  if (is_on_line(seen.line, kernel)) return SecondOrderSample::on_skeleton();
  const Profile profile(kernel, 1);
  integrate_segment(segment, seen, kernel, profile, [&](const SegmentNode& node) {
    sum += second_order_source(profile, node.v, node.tau, node.weight);
  });
  return limited(sum);
}

SecondOrderSample second_order(const TriangleSkeleton& triangle, const Vec3d& p, const Kernel& kernel) {
  if (kernel.family == KernelFamily::Compact)
    return by_differences(triangle, p, [&](const TriangleSkeleton& seen, const Vec3d& q) {
      return triangle_field<Derivatives::Second>(seen, q, kernel);
    });
  if (is_on(triangle, p, kernel)) return SecondOrderSample::on_skeleton();
  const Profile profile(kernel, 2);
  return limited(integrate_triangle<Sum>(triangle, p, kernel, [&](const Vec3d& w, double tau, double weight, Sum& sum) {
                   sum.second += second_order_source(profile, w, tau, weight / (profile.normalisation() * tau * tau));
                 }).second);
}

SecondOrderSample second_order(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel) {
  if (kernel.family == KernelFamily::Compact)
    return by_differences(arc, p, [&](const ArcSkeleton& seen, const Vec3d& q) {
      return arc_field<Derivatives::Second>(seen, q, kernel);
    });
  if (is_on(arc, p, kernel)) return SecondOrderSample::on_skeleton();
  const Profile profile(kernel, 1);
  return limited(integrate_arc<Sum>(arc, p, kernel, [&](const Vec3d& v, double tau, double, double weight, Sum& sum) {
                   sum.second += second_order_source(profile, v, tau, weight / (profile.normalisation() * tau));
                 }).second);
}

// f = R^2 I / 2 and grad_S f = R^3 grad I / 2, with the radius R at the foot of p.
SecondOrderSample second_order_of_cani_hornus(const SegmentSkeleton& s, const Vec3d& p) {
  const double length = marrow::length(s.to - s.from);
  if (!(length > 0)) return {};
  SecondOrderSample sample = second_order(SegmentSkeleton{s.from, s.to, 1, 1}, p, Kernel{KernelFamily::Inverse, 3, 1});
  if (!(sample.field.value <= field_ceiling)) return SecondOrderSample::on_skeleton();
  const HessianJet share = clamp(dot(variables_at<HessianJet>(p) - s.from, (s.to - s.from) / (length * length)), 0, 1);
  const HessianJet radius = s.radius_from + (s.radius_to - s.radius_from) * share, squared = square(radius);
  sample.field = sample.field * squared;
  for (std::size_t c = 0; c < 3; ++c) sample.si[c] = sample.si[c] * (squared * radius);
  return sample;
}

}  // namespace marrow
