// Laws of single primitives.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include <gtest/gtest.h>

#include "field/kernel/inverse_family.h"
#include "field/math/box3.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::numeric_gradient;
using test::Random;
using test::relative;

constexpr auto second = Derivatives::Second;

// Calls check(field, name) with each kind of primitive as a function of point and degree.
template <class Check>
void for_each_primitive(Random& random, const Check& check) {
  const PointSkeleton point = random.point();
  const SegmentSkeleton segment = random.segment();
  check([=](const Vec3d& p, int n) { return point_field<second>(point, p, n); }, "point");
  check([=](const Vec3d& p, int n) { return segment_field<second>(segment, p, n); }, "segment");
  check([=](const Vec3d& p, int n) { return distance_segment_field<second>(segment, p, n); }, "distance segment");
  const TriangleSkeleton triangle = random.triangle();
  const ArcSkeleton arc = random.arc();
  check([=](const Vec3d& p, int n) { return triangle_field<second>(triangle, p, n); }, "triangle");
  check([=](const Vec3d& p, int n) { return arc_field<second>(arc, p, n); }, "arc");
}

TEST(Skeleton, GradientsAndJacobianAreTheDerivatives) {
  Random random(11);
  int checked = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3d p = random.vector(3);
    const int n = random.whole(3, 9);
    for_each_primitive(random, [&](const auto& field, const char* name) {
      const SkeletonSample s = field(p, n);
      if (s.value > 1e3) return;  // near the skeleton differences are too coarse
      ++checked;
      const auto value = [&](const Vec3d& q) { return field(q, n).value; };
      EXPECT_LE(relative(numeric_gradient(value, p, 2e-4), s.gradient), 1e-6) << name << " n " << n;
      double magnitude = 0;
      for (const Vec3d& row : s.si_jacobian.rows) magnitude += length(row);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto component = [&](const Vec3d& q) { return field(q, n).si_gradient[k]; };
        const Vec3d numeric = numeric_gradient(component, p, 2e-4);
        EXPECT_LE(length(numeric - s.si_jacobian.rows[k]), 1e-5 * magnitude) << name << " n " << n;
      }
    });
  }
  EXPECT_GT(checked, 1000);
}

TEST(Skeleton, IsInvariantUnderScaling) {
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    const SegmentSkeleton s = random.segment();
    const Vec3d p = random.vector(3);
    const double k = exp(random.between(-6, 6));
    const int n = random.whole(3, 20);
    const SegmentSkeleton scaled{s.from * k, s.to * k, s.radius_from * k, s.radius_to * k};
    for (const auto field : {segment_field<second>, distance_segment_field<second>}) {
      const SkeletonSample a = field(s, p, n), b = field(scaled, p * k, n);
      if (a.value > 1e6) continue;
      EXPECT_LE(relative(a.value, b.value), 1e-11);
      EXPECT_LE(relative(a.si_gradient, b.si_gradient), 1e-11);
      EXPECT_LE(relative(a.gradient, b.gradient * k), 1e-11);
    }
  }
}

// Cut anywhere, in up to a dozen parts, short ones among them.
TEST(Segment, FieldIsTheSumOfItsParts) {
  Random random(13);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const SegmentSkeleton s = random.segment();
    const Vec3d p = random.vector(i % 2 == 0 ? 2 : 20);
    const int n = random.whole(3, 20);
    const SkeletonSample whole = segment_field<second>(s, p, n);
    if (whole.value > 1e6) continue;
    std::vector<double> cuts{0, 1};
    for (int k = random.whole(1, 11); k > 0; --k) cuts.push_back(k == 2 ? 1e-3 : random.between(0.001, 0.999));
    std::sort(cuts.begin(), cuts.end());
    SkeletonSample parts;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const auto radius = [&](double cut) { return s.radius_from + (s.radius_to - s.radius_from) * cut; };
      parts += segment_field<second>(
          {lerp(s.from, s.to, cuts[k]), lerp(s.from, s.to, cuts[k + 1]), radius(cuts[k]), radius(cuts[k + 1])}, p, n);
    }
    worst = std::max({worst, relative(whole.value, parts.value), relative(whole.gradient, parts.gradient),
                      relative(whole.si_gradient, parts.si_gradient)});
  }
  std::cout << "  worst relative difference " << worst << '\n';
  EXPECT_LE(worst, 1e-13);
}

TEST(Segment, LongSegmentLiesOnTheReferenceCurveWithItsRadius) {
  for (int n = min_kernel_degree + 1; n <= max_kernel_degree; ++n) {
    const SegmentSkeleton s{{-1e6, 0, 0}, {1e6, 0, 0}, 0.5, 0.5};
    const SkeletonSample at_surface = segment_field<second>(s, {0, 0.3, 0.4}, n);
    EXPECT_LE(relative(at_surface.value, 1.0), 1e-12) << n;
    const SkeletonSample off = segment_field<second>(s, {0, 0.9, 0}, n);
    EXPECT_LE(relative(length(off.si_gradient), ReferenceCurve(n).at(off.value)), 1e-12) << n;
  }
}

TEST(DistanceSegment, LiesOnTheReferenceCurve) {
  Random random(14);
  for (int i = 0; i < 300; ++i) {
    const int n = random.whole(3, 20);
    const SkeletonSample s = distance_segment_field<second>(random.segment(), random.vector(3), n);
    if (s.value > 1e20) continue;
    EXPECT_LE(relative(length(s.si_gradient), ReferenceCurve(n).at(s.value)), 1e-12);
  }
}

TEST(Skeleton, LevelsOfDerivativesAgreeBitForBit) {
  Random random(15);
  for (int i = 0; i < 300; ++i) {
    const SegmentSkeleton segment = random.segment();
    const Vec3d p = random.vector(2);
    const int n = random.whole(3, 20);
    const auto a = segment_field<Derivatives::ScaleInvariant>(segment, p, n);
    const auto b = segment_field<Derivatives::First>(segment, p, n);
    const auto c = segment_field<Derivatives::Second>(segment, p, n);
    EXPECT_EQ(a.value, c.value);
    EXPECT_EQ(a.si_gradient, c.si_gradient);
    EXPECT_EQ(b.gradient, c.gradient);
    EXPECT_EQ(distance_segment_field<Derivatives::ScaleInvariant>(segment, p, n).si_gradient,
              distance_segment_field<Derivatives::Second>(segment, p, n).si_gradient);
    const TriangleSkeleton triangle = random.triangle();
    EXPECT_EQ(triangle_field<Derivatives::ScaleInvariant>(triangle, p, n).si_gradient,
              triangle_field<Derivatives::Second>(triangle, p, n).si_gradient);
    const ArcSkeleton arc = random.arc();
    EXPECT_EQ(arc_field<Derivatives::First>(arc, p, n).gradient, arc_field<Derivatives::Second>(arc, p, n).gradient);
  }
}

TEST(Skeleton, IsInfiniteOnItselfWithoutDerivatives) {
  const PointSkeleton point{{1, 2, 3}, 0.5};
  const SegmentSkeleton segment{{0, 0, 0}, {2, 0, 0}, 0.5, 0.25};
  for (int n = min_kernel_degree; n <= max_kernel_degree; ++n) {
    EXPECT_EQ(point_field<second>(point, point.at, n).value, Box3::inf);
    for (const double t : {0.0, 0.3, 1.0}) {
      const Vec3d on = lerp(segment.from, segment.to, t);
      for (const auto field : {segment_field<second>, distance_segment_field<second>}) {
        const SkeletonSample s = field(segment, on, n);
        EXPECT_EQ(s.value, Box3::inf) << n << ' ' << t;
        EXPECT_EQ(s.gradient, Vec3d{});
        EXPECT_EQ(s.si_jacobian, Matrix3{});
      }
    }
  }
}

TEST(Skeleton, EveryNumberIsFiniteFromVeryNearToVeryFar) {
  const SegmentSkeleton segment{{0, 0, 0}, {2, 0, 0}, 0.5, 0.25};
  for (int n = min_kernel_degree; n <= max_kernel_degree; ++n)
    for (int e = -200; e <= 150; e += 5) {
      const Vec3d p{1, pow(10, e), 0};
      for (const auto field : {segment_field<second>, distance_segment_field<second>}) {
        const SkeletonSample s = field(segment, p, n);
        EXPECT_FALSE(std::isnan(s.value));
        EXPECT_TRUE(is_finite(s.gradient) && is_finite(s.si_gradient)) << "n " << n << " 1e" << e;
        for (const Vec3d& row : s.si_jacobian.rows) EXPECT_TRUE(is_finite(row)) << "n " << n << " 1e" << e;
      }
    }
}

}  // namespace
}  // namespace marrow
