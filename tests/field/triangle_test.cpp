// Laws of the field of a triangle.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "field/kernel/inverse_family.h"
#include "field/math/box3.h"
#include "field/skeleton/even_lines.h"
#include "field/skeleton/skeletons.h"
#include "field/skeleton/triangle_methods.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;
using test::relative;

constexpr auto second = Derivatives::Second;

double difference(const SkeletonSample& a, const SkeletonSample& b) {
  return std::max(
      {relative(a.value, b.value), relative(a.gradient, b.gradient), relative(a.si_gradient, b.si_gradient)});
}

TEST(Triangle, FieldIsTheSumOfItsParts) {
  Random random(81);
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const TriangleSkeleton t = random.triangle();
    const auto& [a, b, c] = t.vertices;
    const Vec3d p = random.vector(i % 2 == 0 ? 2 : 20);
    const int n = random.whole(3, 12);
    const SkeletonSample whole = triangle_field<second>(t, p, n);
    if (whole.value > 1e4) continue;
    const double cut = random.between(0.2, 0.8);
    const Vec3d middle = lerp(a, b, cut);
    const double radius = t.radii[0] + (t.radii[1] - t.radii[0]) * cut;
    SkeletonSample parts = triangle_field<second>({{a, middle, c}, {t.radii[0], radius, t.radii[2]}}, p, n);
    parts += triangle_field<second>({{middle, b, c}, {radius, t.radii[1], t.radii[2]}}, p, n);
    worst = std::max(worst, difference(whole, parts));
  }
  std::cout << "  worst relative difference " << worst << '\n';
  EXPECT_LE(worst, 1e-12);
}

TEST(Triangle, DoesNotDependOnTheOrderOfItsVertices) {
  Random random(82);
  for (int i = 0; i < 100; ++i) {
    const TriangleSkeleton t = random.triangle();
    const Vec3d p = random.vector(2);
    const int n = random.whole(3, 12);
    const TriangleSkeleton other{{t.vertices[2], t.vertices[1], t.vertices[0]}, {t.radii[2], t.radii[1], t.radii[0]}};
    const SkeletonSample a = triangle_field<second>(t, p, n);
    if (a.value > 1e4) continue;
    EXPECT_LE(difference(a, triangle_field<second>(other, p, n)), 1e-12);
  }
}

TEST(Triangle, WidePlateLiesOnTheReferenceCurveWithItsRadius) {
  for (int n = min_kernel_degree + 1; n <= max_kernel_degree; ++n) {
    const TriangleSkeleton plate{{Vec3d{-4e6, -3e6, 0}, {4e6, -3e6, 0}, {0, 5e6, 0}}, {0.5, 0.5, 0.5}};
    EXPECT_LE(relative(triangle_field<second>(plate, {0.3, 0.1, 0.5}, n).value, 1.0), 1e-12) << n;
    const SkeletonSample off = triangle_field<second>(plate, {0, 0, -0.9}, n);
    EXPECT_LE(relative(length(off.si_gradient), ReferenceCurve(n).at(off.value)), 1e-12) << n;
  }
}

TEST(Triangle, IsInfiniteOnItselfAndFiniteInItsPlaneBeside) {
  const TriangleSkeleton t{{Vec3d{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {0.5, 0.5, 0.25}};
  for (int n = min_kernel_degree; n <= max_kernel_degree; ++n) {
    for (const Vec3d& on : {Vec3d{0.5, 0.5, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}}) {
      EXPECT_EQ(triangle_field<second>(t, on, n).value, Box3::inf);
      EXPECT_EQ(triangle_field<second>(t, on, n).gradient, Vec3d{});
    }
    const SkeletonSample beside = triangle_field<second>(t, {1.2, 1.2, 0}, n);
    EXPECT_TRUE(beside.value > 0 && std::isfinite(beside.value));
    EXPECT_EQ(beside.gradient.z, 0);
    for (int e = -40; e <= 40; e += 4) {
      const SkeletonSample s = triangle_field<second>(t, {0.5, 0.5, pow(10, e)}, n);
      EXPECT_FALSE(std::isnan(s.value));
      EXPECT_TRUE(is_finite(s.gradient) && is_finite(s.si_gradient)) << "n " << n << " 1e" << e;
    }
  }
}

double jacobian_difference(const SkeletonSample& a, const SkeletonSample& b) {
  double off = 0, size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    off += length(a.si_jacobian.rows[i] - b.si_jacobian.rows[i]);
    size += length(b.si_jacobian.rows[i]);
  }
  return off / size;
}

// Largest differences of samples that should be the same.
struct Comparison {
  int count = 0;
  double worst = 0, worst_jacobian = 0;

  // what is not a number stays
  static void keep_worse(double& worst, double x) {
    if (!(x <= worst)) worst = x;
  }
  void add(const SkeletonSample& a, const SkeletonSample& b) {
    keep_worse(worst, difference(a, b));
    keep_worse(worst_jacobian, jacobian_difference(a, b));
    ++count;
  }
};
void expect_same(const Comparison& compared, int more_than, double tolerance) {
  std::cout << "  worst relative difference of " << compared.count << ": " << compared.worst << ", of Jacobians "
            << compared.worst_jacobian << '\n';
  EXPECT_GT(compared.count, more_than);
  EXPECT_LE(compared.worst, tolerance);
  EXPECT_LE(compared.worst_jacobian, tolerance);
}

// Above a triangle, of one radius or not, and beside it in and near its plane, from a thousandth of its size away.
struct NearPlace {
  TriangleSkeleton triangle;
  Vec3d p;
};
NearPlace place_near_triangle(Random& random, int i) {
  TriangleSkeleton t = random.triangle();
  const double radius = exp(random.between(-7, 0)), u = random.between(0, 1), v = random.between(0, 1 - u);
  t.radii = {radius, radius, radius};
  if (i % 2 == 0) t.radii = {radius, radius * random.between(0.05, 1), radius * random.between(0.05, 1)};
  const auto& [a, b, c] = t.vertices;
  const Vec3d across = cross(b - a, c - a), normal = across / length(across);
  const Vec3d up = normal * (radius * exp(random.between(-1, 2)));
  if (i % 3 == 0) return {t, a + (b - a) * u + (c - a) * v + up};
  const Vec3d on_side = a + (b - a) * u, out = cross(b - a, normal) / length(b - a);
  return {t, on_side + out * (radius * exp(random.between(-2, 2))) + (i % 3 == 1 ? up : Vec3d{})};
}

// Lines lose more digits than sides where a triangle is many radii wide.
// Of the doubles beside a vertex: an integral of what is positive is not below 0.
TEST(Triangle, IsInsideWithinRoundingOfAVertex) {
  const TriangleSkeleton triangle{{Vec3d{0, 0, 0}, {1, 0, 0}, {0.3, 0.9, 0.2}}, {0.2, 0.2, 0.2}};
  const auto beside = [](double x, int ulps) {
    for (; ulps > 0; --ulps) x = std::nextafter(x, 2.0);
    for (; ulps < 0; ++ulps) x = std::nextafter(x, -2.0);
    return x;
  };
  for (const int degree : {3, 4, 6, 10, 20})
    for (int x = -4; x <= 4; ++x)
      for (int y = -4; y <= 4; ++y)
        for (int z = -4; z <= 4; ++z) {
          const Vec3d p{beside(0.3, x), beside(0.9, y), beside(0.2, z)};
          const SkeletonSample sample = triangle_field<Derivatives::Second>(triangle, p, degree);
          ASSERT_GT(sample.value, 1e3) << degree << ' ' << x << ' ' << y << ' ' << z;
          ASSERT_TRUE(is_finite(sample.gradient));
        }
  EXPECT_GT(triangle_field<Derivatives::First>({{Vec3d{0, 0, 0.5}, {1, 0, 0}, {0, 0, 1}}, {0.2, 0.2, 0.2}},
                                               {1, 5e-81, 7e-81}, 3)
                .value,
            1e3);
}

TEST(Triangle, IsTheSameBySidesAndByLines) {
  Random random(83);
  Comparison compared;
  for (int i = 0; i < 3000; ++i) {
    const auto [t, p] = place_near_triangle(random, i);
    const int n = random.whole(min_kernel_degree, max_kernel_degree);
    const auto sides = triangle_by_sides<second>(t, p, n);
    if (!sides || sides->value > 1e4) continue;
    compared.add(*sides, triangle_by_lines<second>(t, p, n));
  }
  expect_same(compared, 2000, 1e-9);
}

// One radius for all, under a kernel of a family.
Kernel even_kernel(Random& random, KernelFamily family, TriangleSkeleton& triangle) {
  triangle.radii = {triangle.radii[0], triangle.radii[0], triangle.radii[0]};
  const double shape = family == KernelFamily::Compact ? random.between(1.2, 4) : random.between(0.5, 3);
  return {family, random.whole(min_kernel_degree, max_kernel_degree), shape};
}

TEST(Triangle, IsTheSameBySidesAndByLinesUnderAnyKernel) {
  Random random(85);
  for (const KernelFamily family : {KernelFamily::Compact, KernelFamily::Cauchy}) {
    Comparison compared;
    for (int i = 0; i < 600; ++i) {
      auto [t, p] = place_near_triangle(random, i);
      const Kernel kernel = even_kernel(random, family, t);
      const auto sides = triangle_by_sides<second>(t, p, kernel);
      if (!sides || sides->value < 1e-6) continue;
      compared.add(*sides, triangle_by_lines<second>(t, p, kernel));
    }
    expect_same(compared, 200, 1e-10);
  }
}

// Those of one radius each, and those parallel to a side, of radii that vary.
TEST(Triangle, IsTheSameByAnyLinesWhereRadiiVary) {
  Random random(87);
  for (const KernelFamily family : {KernelFamily::Compact, KernelFamily::Cauchy}) {
    Comparison compared;
    for (int i = 0; i < 400; ++i) {
      const auto [t, p] = place_near_triangle(random, 2 * i);
      const Kernel kernel{family, random.whole(min_kernel_degree, max_kernel_degree), random.between(1.2, 3)};
      const auto lines = triangle_by_lines<second>(t, p, kernel);
      if (lines.value < 1e-6) continue;
      compared.add(lines, triangle_by_even_lines<second>(t, p, kernel));
    }
    expect_same(compared, 150, 1e-9);
  }
}

TEST(Triangle, SidesKeepTheirDigitsWhereTheTriangleIsCut) {
  Random random(84);
  Comparison compared;
  for (int i = 0; i < 3000; ++i) {
    const auto [t, p] = place_near_triangle(random, i);
    const auto& [a, b, c] = t.vertices;
    const int n = random.whole(min_kernel_degree, max_kernel_degree);
    const double share = random.between(0.3, 0.7), radius = t.radii[1] + (t.radii[2] - t.radii[1]) * share;
    const Vec3d middle = lerp(b, c, share);
    const auto whole = triangle_by_sides<second>(t, p, n);
    const auto left = triangle_by_sides<second>({{a, b, middle}, {t.radii[0], t.radii[1], radius}}, p, n),
               right = triangle_by_sides<second>({{a, middle, c}, {t.radii[0], radius, t.radii[2]}}, p, n);
    if (!whole || !left || !right || whole->value > 1e4) continue;
    SkeletonSample parts = *left;
    parts += *right;
    compared.add(*whole, parts);
  }
  expect_same(compared, 1000, 1e-10);
}

TEST(Triangle, SidesKeepTheirDigitsUnderAnyKernelWhereTheTriangleIsCut) {
  Random random(86);
  for (const KernelFamily family : {KernelFamily::Compact, KernelFamily::Cauchy}) {
    Comparison compared;
    for (int i = 0; i < 3000; ++i) {
      auto [t, p] = place_near_triangle(random, i);
      const Kernel kernel = even_kernel(random, family, t);
      const auto& [a, b, c] = t.vertices;
      const Vec3d middle = lerp(b, c, random.between(0.3, 0.7));
      const auto whole = triangle_by_sides<second>(t, p, kernel);
      const auto left = triangle_by_sides<second>({{a, b, middle}, t.radii}, p, kernel),
                 right = triangle_by_sides<second>({{a, middle, c}, t.radii}, p, kernel);
      if (!whole || !left || !right || whole->value < 1e-9) continue;
      SkeletonSample parts = *left;
      parts += *right;
      compared.add(*whole, parts);
    }
    expect_same(compared, 1000, 1e-10);
  }
}

// The support's edge is where it should be, and what is beyond has no field.
TEST(Triangle, CompactSupportEndsAtItsEdge) {
  const TriangleSkeleton t{{Vec3d{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {0.5, 0.5, 0.5}};
  for (int n = min_kernel_degree; n <= max_kernel_degree; ++n)
    for (const Vec3d& away : {Vec3d{0, 0, 1}, {-0.6, -0.8, 0}, {-1, 0, 0}, {0, -0.8, 0.6}}) {
      const Kernel kernel{KernelFamily::Compact, n, 2};
      const Vec3d on = away.z == 1 || away.x == 0 ? Vec3d{0.6, away.z == 1 ? 0.6 : 0, 0} : Vec3d{};
      EXPECT_EQ(triangle_field<second>(t, on + away * 1.0001, kernel).value, 0);
      const SkeletonSample inside = triangle_field<second>(t, on + away * 0.95, kernel);
      EXPECT_TRUE(inside.value > 0 && dot(inside.si_gradient, away) < 0);
    }
}

TEST(Triangle, WithoutAreaHasNoField) {
  const TriangleSkeleton flat{{Vec3d{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {1, 1, 1}};
  EXPECT_EQ(triangle_field<second>(flat, {0, 1, 0}, 4).value, 0);
}

}  // namespace
}  // namespace marrow
