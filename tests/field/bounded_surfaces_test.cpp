// Laws of arcs and triangles under the Cauchy and the compact kernel.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"
#include "tests/field/ring_of.h"

namespace marrow {
namespace {

using test::numeric_gradient;
using test::Random;
using test::relative;
using test::ring_of;

constexpr auto second = Derivatives::Second;

Kernel random_kernel(Random& random, int i) {
  const int n = random.whole(3, 9);
  return i % 2 == 0 ? Kernel{KernelFamily::Cauchy, n, random.between(0.5, 2)}
                    : Kernel{KernelFamily::Compact, n, random.between(1.5, 3)};
}

TEST(BoundedSurfaces, AWidePlateHasItsSurfaceAtItsRadius) {
  for (int n = 3; n <= 8; ++n) {
    const TriangleSkeleton small{{Vec3d{-9, -9, 0}, {9, -9, 0}, {0, 12, 0}}, {0.5, 0.5, 0.5}};
    EXPECT_NEAR(triangle_field<second>(small, {0.1, 0.2, 0.5}, {KernelFamily::Compact, n, 2}).value, 1, 1e-10) << n;
    const double far = n == 3 ? 1e4 : 1e3;
    const TriangleSkeleton wide{{Vec3d{-far, -far, 0}, {far, -far, 0}, {0, far, 0}}, {0.5, 0.5, 0.5}};
    EXPECT_NEAR(triangle_field<second>(wide, {0.1, 0.2, 0.5}, {KernelFamily::Cauchy, n, 1.3}).value, 1, 1e-6) << n;
  }
}

TEST(BoundedSurfaces, AWideRingIsALine) {
  for (int n = 3; n <= 8; ++n)
    for (const Kernel& kernel : {Kernel{KernelFamily::Cauchy, n, 1}, Kernel{KernelFamily::Compact, n, 2}}) {
      const ArcSkeleton ring = ring_of(1e4, 0.5);
      EXPECT_NEAR(arc_field<second>(ring, {1e4, 0, 0.5}, kernel).value, 1, 1e-4) << n;
    }
}

TEST(BoundedSurfaces, FieldsAreTheSumsOfTheirParts) {
  Random random(421);
  double worst_arc = 0, worst_triangle = 0;
  for (int i = 0; i < 160; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const ArcSkeleton arc = random.arc();
    const Vec3d p = random.vector(2);
    const double share = random.between(0.1, 0.9);
    ArcSkeleton first = arc, rest = arc;
    first.end = rest.begin = arc.begin + (arc.end - arc.begin) * share;
    first.radius_to = rest.radius_from = arc.radius_from + (arc.radius_to - arc.radius_from) * share;
    const SkeletonSample whole = arc_field<second>(arc, p, kernel);
    SkeletonSample parts = arc_field<second>(first, p, kernel);
    parts += arc_field<second>(rest, p, kernel);
    if (whole.value > 1e-6)
      worst_arc = std::max({worst_arc, relative(whole.value, parts.value), relative(whole.gradient, parts.gradient)});
    if (i % 4 > 1) continue;
    const TriangleSkeleton t = random.triangle();
    TriangleSkeleton left = t, right = t;
    left.vertices[2] = right.vertices[1] = lerp(t.vertices[1], t.vertices[2], share);
    left.radii[2] = right.radii[1] = t.radii[1] + (t.radii[2] - t.radii[1]) * share;
    const SkeletonSample all = triangle_field<second>(t, p, kernel);
    SkeletonSample halves = triangle_field<second>(left, p, kernel);
    halves += triangle_field<second>(right, p, kernel);
    if (all.value > 1e-6)
      worst_triangle =
          std::max({worst_triangle, relative(all.value, halves.value), relative(all.si_gradient, halves.si_gradient)});
  }
  std::cout << "  worst relative difference: arcs " << worst_arc << ", triangles " << worst_triangle << '\n';
  EXPECT_LE(worst_arc, 1e-9);
  EXPECT_LE(worst_triangle, 1e-9);
}

TEST(BoundedSurfaces, GradientsAndJacobianAreTheDerivatives) {
  Random random(422);
  int arcs = 0, triangles = 0;
  const auto check = [&](const auto& at, const Vec3d& p) {
    const SkeletonSample s = at(p);
    if (s.value < 0.05) return 0;
    EXPECT_LE(relative(numeric_gradient([&](const Vec3d& q) { return at(q).value; }, p, 3e-4), s.gradient), 1e-5);
    double magnitude = 0;
    for (const Vec3d& row : s.si_jacobian.rows) magnitude += length(row);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component = [&](const Vec3d& q) { return at(q).si_gradient[k]; };
      EXPECT_LE(length(numeric_gradient(component, p, 3e-4) - s.si_jacobian.rows[k]), 1e-4 * magnitude);
    }
    return 1;
  };
  for (int i = 0; i < 60; ++i) {
    // the third derivative of low compact kernels is not bounded where their support begins
    Kernel kernel = random_kernel(random, i);
    kernel.degree = std::max(kernel.degree, kernel.family == KernelFamily::Compact ? 9 : 3);
    const ArcSkeleton arc = random.arc();
    const TriangleSkeleton t = random.triangle();
    const Vec3d p = random.vector(1.5);
    arcs += check([&](const Vec3d& q) { return arc_field<second>(arc, q, kernel); }, p);
    if (i % 4 < 2) triangles += check([&](const Vec3d& q) { return triangle_field<second>(t, q, kernel); }, p);
  }
  EXPECT_GT(arcs, 10);
  EXPECT_GT(triangles, 5);
}

// Kernels of low degree are not smooth at the edge of their support, under the integral: what is beside the edge is.
TEST(BoundedSurfaces, JacobiansUnderCompactKernelsOfLowDegreeAreTheDerivatives) {
  Random random(423);
  int checked = 0;
  double worst = 0;
  const auto check = [&](const auto& at, const Vec3d& p) {
    const SkeletonSample s = at(p);
    if (s.value < 1e-3) return;
    double magnitude = 0, off = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component = [&](const Vec3d& q) { return at(q).si_gradient[k]; };
      magnitude += length(s.si_jacobian.rows[k]);
      off += length(numeric_gradient(component, p, 1e-5) - s.si_jacobian.rows[k]);
    }
    EXPECT_LE(off, 1e-6 * magnitude) << "check " << checked;
    ++checked;
    worst = std::max(worst, off / magnitude);
  };
  for (int i = 0; i < 100; ++i) {
    const Kernel kernel{KernelFamily::Compact, random.whole(3, 6), random.between(1.2, 2)};
    const ArcSkeleton arc = random.arc();
    const TriangleSkeleton t = random.triangle();
    check([&](const Vec3d& q) { return arc_field<second>(arc, q, kernel); }, random.vector(1.2));
    const double x = random.between(-0.2, 1), y = random.between(-0.2, 1);
    const Vec3d beside =
        t.vertices[0] + (t.vertices[1] - t.vertices[0]) * x + (t.vertices[2] - t.vertices[0]) * y + random.vector(0.2);
    if (i % 3 == 0) check([&](const Vec3d& q) { return triangle_field<second>(t, q, kernel); }, beside);
  }
  std::cout << "  worst relative difference of " << checked << ": " << worst << '\n';
  EXPECT_GT(checked, 50);
}

TEST(BoundedSurfaces, CompactKernelsEndAtTheirSupport) {
  const Kernel kernel{KernelFamily::Compact, 5, 2};
  const TriangleSkeleton t{{Vec3d{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0.5, 0.5, 0.5}};
  EXPECT_EQ(triangle_field<second>(t, {0.2, 0.2, 1.0001}, kernel).value, 0);
  EXPECT_GT(triangle_field<second>(t, {0.2, 0.2, 0.98}, kernel).value, 0);
  const ArcSkeleton ring = ring_of(2, 0.5);
  EXPECT_EQ(arc_field<second>(ring, {0, 0, 0}, kernel).value, 0);
  EXPECT_EQ(arc_field<second>(ring, {3.0001, 0, 0}, kernel).value, 0);
  EXPECT_GT(arc_field<second>(ring, {2.98, 0, 0}, kernel).value, 0);
}

}  // namespace
}  // namespace marrow
