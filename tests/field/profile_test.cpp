// Laws of points and segments under the Cauchy and the compact kernel.
#include "field/kernel/profile.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "field/kernel/inverse_family.h"
#include "field/program/field_program.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::numeric_gradient;
using test::Random;
using test::relative;

constexpr auto second = Derivatives::Second;

Kernel random_kernel(Random& random, int i) {
  const int n = random.whole(3, 12);
  return i % 2 == 0 ? Kernel{KernelFamily::Cauchy, n, random.between(0.5, 2)}
                    : Kernel{KernelFamily::Compact, n, random.between(1.5, 3)};
}

TEST(Profile, SurfaceOfALoneSkeletonLiesAtItsRadius) {
  for (int n = min_kernel_degree; n <= max_kernel_degree; ++n)
    for (const Kernel& kernel : {Kernel{KernelFamily::Cauchy, n, 1.3}, Kernel{KernelFamily::Compact, n, 2}}) {
      EXPECT_LE(relative(point_field<second>({{1, 0, 0}, 0.5}, {1, 0.3, 0.4}, kernel).value, 1.0), 1e-13) << n;
      const double far = n == 3 ? 1e8 : 1e5;
      const SegmentSkeleton line{{-far, 0, 0}, {far, 0, 0}, 0.5, 0.5};
      EXPECT_LE(relative(segment_field<second>(line, {0, 0.3, 0.4}, kernel).value, 1.0), 1e-12) << n;
    }
}

TEST(Profile, FieldIsTheSumOfItsParts) {
  Random random(101);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const SegmentSkeleton s = random.segment();
    const Vec3d p = random.vector(2);
    const SkeletonSample whole = segment_field<second>(s, p, kernel);
    if (whole.value < 1e-6) continue;
    const double cut = random.between(0.05, 0.95);
    const Vec3d middle = lerp(s.from, s.to, cut);
    const double radius = s.radius_from + (s.radius_to - s.radius_from) * cut;
    SkeletonSample parts = segment_field<second>({s.from, middle, s.radius_from, radius}, p, kernel);
    parts += segment_field<second>({middle, s.to, radius, s.radius_to}, p, kernel);
    worst = std::max({worst, relative(whole.value, parts.value), relative(whole.si_gradient, parts.si_gradient)});
  }
  std::cout << "  worst relative difference " << worst << '\n';
  EXPECT_LE(worst, 1e-11);
}

TEST(Profile, GradientsAndJacobianAreTheDerivatives) {
  Random random(102);
  int checked = 0;
  for (int i = 0; i < 1600; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const SegmentSkeleton s = random.segment();
    const Vec3d p = random.vector(2);
    const SkeletonSample sample = segment_field<second>(s, p, kernel);
    // the third derivative of low compact kernels is not bounded where their support begins
    if (sample.value < 0.05 || (kernel.family == KernelFamily::Compact && kernel.degree < 8)) continue;
    ++checked;
    const auto value = [&](const Vec3d& q) { return segment_field<second>(s, q, kernel).value; };
    EXPECT_LE(relative(numeric_gradient(value, p, 2e-4), sample.gradient), 1e-6);
    double magnitude = 0;
    for (const Vec3d& row : sample.si_jacobian.rows) magnitude += length(row);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component = [&](const Vec3d& q) { return segment_field<second>(s, q, kernel).si_gradient[k]; };
      EXPECT_LE(length(numeric_gradient(component, p, 2e-4) - sample.si_jacobian.rows[k]), 1e-5 * magnitude);
    }
  }
  EXPECT_GT(checked, 120);
}

TEST(Profile, CompactKernelsEndAtTheirSupport) {
  const Kernel kernel{KernelFamily::Compact, 5, 2};
  const SegmentSkeleton s{{0, 0, 0}, {1, 0, 0}, 0.5, 0.2};
  EXPECT_EQ(point_field<second>({{0, 0, 0}, 0.5}, {1.0001, 0, 0}, kernel).value, 0);
  EXPECT_GT(point_field<second>({{0, 0, 0}, 0.5}, {0.9999, 0, 0}, kernel).value, 0);
  EXPECT_EQ(segment_field<second>(s, {-1.0001, 0, 0}, kernel).value, 0);
  EXPECT_EQ(segment_field<second>(s, {-1.0001, 0, 0}, kernel).gradient, Vec3d{});
  EXPECT_GT(segment_field<second>(s, {0.5, 0, 0}, kernel).value, 1);
}

TEST(Profile, ItsBlendsTakeAnglesFromZeroOn) {
  const auto result_of = [](Alpha alpha, SkeletonModel model, Kernel kernel) {
    FieldDescription description;
    Primitive primitive;
    primitive.skeleton = SegmentSkeleton{{0, 0, 0}, {1, 0, 0}, 1, 1};
    Blend blend;
    blend.kernel = kernel;
    blend.alpha = alpha;
    blend.model = model;
    blend.of = {description.add({.what = primitive, .where = {}})};
    description.root = description.add({.what = blend, .where = {}});
    return compile(description);
  };
  const Kernel cauchy{KernelFamily::Cauchy, 4, 1}, compact{KernelFamily::Compact, 4, 0.5};
  const auto good = result_of(AlphaSum{}, SkeletonModel::Integral, cauchy);
  ASSERT_TRUE(good);
  EXPECT_FALSE(untraceable_part(good->parts()[0].blend).empty());
  EXPECT_GT(value(*good, {0.5, 0, 0}), 1);
  const auto contact = result_of(AlphaContact{}, SkeletonModel::Integral, cauchy);
  ASSERT_TRUE(contact);
  EXPECT_TRUE(contact->warnings().empty());
  EXPECT_TRUE(result_of(0.8, SkeletonModel::Integral, cauchy));
  EXPECT_FALSE(result_of(-0.1, SkeletonModel::Integral, cauchy));
  const auto wide = result_of(AlphaContact{}, SkeletonModel::Integral, Kernel{KernelFamily::Compact, 4, 2});
  ASSERT_TRUE(wide);
  ASSERT_EQ(wide->warnings().size(), 1u);
  EXPECT_NE(wide->warnings()[0].message.find("before they touch"), std::string::npos);
  const auto hollow = result_of(0.1, SkeletonModel::Integral, Kernel{KernelFamily::Compact, 4, 2});
  ASSERT_TRUE(hollow);
  ASSERT_EQ(hollow->warnings().size(), 1u);
  EXPECT_NE(hollow->warnings()[0].message.find("hollow"), std::string::npos);
  EXPECT_TRUE(result_of(AlphaSum{}, SkeletonModel::Distance, cauchy));
  EXPECT_FALSE(result_of(AlphaSum{}, SkeletonModel::Integral, compact));
}

}  // namespace
}  // namespace marrow
