// A field does not change when it is moved, however far: nothing is computed from positions but from their differences.
#include <cmath>

#include <gtest/gtest.h>

#include "field/skeleton/second_order.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"
#include "tests/field/random_kernel.h"

namespace marrow {
namespace {

using test::Random;
using test::random_kernel;

// A million units away; whole multiples of 2^-20 so far out are doubles, so that moving them there rounds nothing.
const Vec3d shift{0x1p20, -0x1p20, 0x1p19};
Vec3d coarse(const Vec3d& v) {
  const auto whole = [](double x) { return std::floor(x * 0x1p20) * 0x1p-20; };
  return {whole(v.x), whole(v.y), whole(v.z)};
}

SegmentSkeleton coarse(SegmentSkeleton s) {
  s.from = coarse(s.from);
  s.to = coarse(s.to);
  return s;
}
TriangleSkeleton coarse(TriangleSkeleton s) {
  for (Vec3d& v : s.vertices) v = coarse(v);
  return s;
}
ArcSkeleton coarse(ArcSkeleton s) {
  s.center = coarse(s.center);
  return s;
}
SegmentSkeleton moved(SegmentSkeleton s) {
  s.from += shift;
  s.to += shift;
  return s;
}
TriangleSkeleton moved(TriangleSkeleton s) {
  for (Vec3d& v : s.vertices) v += shift;
  return s;
}
ArcSkeleton moved(ArcSkeleton s) {
  s.center += shift;
  return s;
}

void expect_same(const SkeletonSample& a, const SkeletonSample& b) {
  constexpr double tolerance = 1e-12;
  EXPECT_LE(std::fabs(a.value - b.value), tolerance * a.value);
  EXPECT_LE(length(a.gradient - b.gradient), tolerance * length(a.gradient));
  EXPECT_LE(length(a.si_gradient - b.si_gradient), tolerance * length(a.si_gradient));
}
void expect_same(const SecondOrderSample& a, const SecondOrderSample& b) {
  constexpr double tolerance = 1e-9;
  double size = 0, off = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    size += std::fabs(a.field.curvature[k]);
    off += std::fabs(a.field.curvature[k] - b.field.curvature[k]);
  }
  EXPECT_LE(std::fabs(a.field.value - b.field.value), 1e-12 * a.field.value);
  EXPECT_LE(off, tolerance * size);
}

SkeletonSample field_of(const SegmentSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return segment_field<Derivatives::Second>(s, p, kernel);
}
SkeletonSample field_of(const TriangleSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return triangle_field<Derivatives::Second>(s, p, kernel);
}
SkeletonSample field_of(const ArcSkeleton& s, const Vec3d& p, const Kernel& kernel) {
  return arc_field<Derivatives::Second>(s, p, kernel);
}

template <class Skeleton>
void expect_moves(const Skeleton& s, const Vec3d& p, const Kernel& kernel) {
  constexpr auto second = Derivatives::Second;
  const Vec3d q = p + shift;
  expect_same(distance_field<second>(s, p, kernel), distance_field<second>(moved(s), q, kernel));
  expect_same(second_order_by_distance(s, p, kernel), second_order_by_distance(moved(s), q, kernel));
  expect_same(second_order(s, p, kernel), second_order(moved(s), q, kernel));
  if (kernel.family != KernelFamily::Inverse) expect_same(field_of(s, p, kernel), field_of(moved(s), q, kernel));
}

TEST(FarFromTheOrigin, FieldsAreTheSame) {
  Random random(20261122);
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(i);
    const Kernel kernel = random_kernel(random, i);
    const Vec3d p = coarse(random.vector(2));
    const SegmentSkeleton segment = coarse(random.segment());
    expect_moves(segment, p, kernel);
    if (kernel.family == KernelFamily::Inverse)
      expect_same(distance_segment_field<Derivatives::Second>(segment, p, kernel.degree),
                  distance_segment_field<Derivatives::Second>(moved(segment), p + shift, kernel.degree));
    expect_moves(coarse(random.triangle()), p, kernel);
    expect_moves(coarse(random.arc()), p, kernel);
  }
}

}  // namespace
}  // namespace marrow
