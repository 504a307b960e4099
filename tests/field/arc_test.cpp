// Laws of the field of arcs and circles.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "field/kernel/inverse_family.h"
#include "field/math/box3.h"
#include "field/math/turned_angle.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;
using test::relative;

constexpr auto second = Derivatives::Second;

ArcSkeleton circle(double major, double radius) {
  ArcSkeleton arc;
  arc.major = major;
  arc.radius_from = arc.radius_to = radius;
  return arc;
}

TEST(Arc, FieldIsTheSumOfItsParts) {
  Random random(91);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const ArcSkeleton arc = random.arc();
    const Vec3d p = random.vector(i % 2 == 0 ? 2 : 20);
    const int n = random.whole(3, 20);
    const SkeletonSample whole = arc_field<second>(arc, p, n);
    if (whole.value > 1e6) continue;
    const double cut = random.between(0.05, 0.95);
    ArcSkeleton first = arc, last = arc;
    first.end = last.begin = arc.begin + (arc.end - arc.begin) * cut;
    first.radius_to = last.radius_from = arc.radius_from + (arc.radius_to - arc.radius_from) * cut;
    SkeletonSample parts = arc_field<second>(first, p, n);
    parts += arc_field<second>(last, p, n);
    worst = std::max({worst, relative(whole.value, parts.value), relative(whole.gradient, parts.gradient),
                      relative(whole.si_gradient, parts.si_gradient)});
  }
  std::cout << "  worst relative difference " << worst << '\n';
  EXPECT_LE(worst, 1e-12);
}

// n = 4: f = 4 tau^3 rho D / (D^2 - C^2)^1.5.
TEST(Arc, CircleOfDegreeFourIsItsClosedForm) {
  Random random(92);
  for (int i = 0; i < 300; ++i) {
    const double rho = random.between(0.3, 3), tau = random.between(0.1, 1);
    const Vec3d p = random.vector(3);
    const double r = std::sqrt(p.x * p.x + p.y * p.y), D = r * r + rho * rho + p.z * p.z, C = 2 * r * rho;
    const double delta = (D - C) * (D + C);
    const double expected = 4 * tau * tau * tau * rho * D / (delta * std::sqrt(delta));
    EXPECT_LE(relative(arc_field<second>(circle(rho, tau), p, 4).value, expected), 1e-12);
  }
}

TEST(Arc, CentreOfATorusHasTheFieldOfTheFormula) {
  for (int n = min_kernel_degree; n <= max_kernel_degree; ++n) {
    const SkeletonSample s = arc_field<second>(circle(2, 2), {0, 0, 0}, n);
    EXPECT_LE(relative(s.value, 2 * std::numbers::pi / curve_normalisation(n)), 1e-14);
    EXPECT_LE(length(s.gradient), 1e-16 * n * s.value);  // terms of n f / 2 in all cancel
  }
}

TEST(Arc, AnglesOfItsNodesAreThoseOfTheLibrary) {
  Random random(66);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const double from = random.between(-7, 7), angle = from + random.between(-1, 1) * std::numbers::pi / 4;
    const SinCos turned = TurnedAngle(from).at(angle), exact = sincos(angle);
    worst = std::max({worst, std::fabs(turned.sin - exact.sin), std::fabs(turned.cos - exact.cos)});
  }
  std::cout << "  off by " << worst << " at most\n";
  EXPECT_LE(worst, 1e-15);  // three roundings, and those of angles up to 8
}

TEST(Arc, ALargeCircleIsALongSegment) {
  const ArcSkeleton wide = circle(1e7, 0.5);
  for (int n = 4; n <= max_kernel_degree; ++n)
    EXPECT_LE(relative(arc_field<second>(wide, {1e7 + 0.5, 0, 0}, n).value, 1.0), 2e-6);
}

TEST(Arc, IsInfiniteOnItself) {
  ArcSkeleton arc = circle(1, 0.3);
  arc.begin = -1;
  arc.end = 2;
  EXPECT_EQ(arc_field<second>(arc, {1, 0, 0}, 4).value, Box3::inf);
  EXPECT_EQ(arc_field<second>(arc, {1, 0, 0}, 4).si_gradient, Vec3d{});
  EXPECT_LT(arc_field<second>(arc, {-1, 0, 0}, 4).value, 1);
}

}  // namespace
}  // namespace marrow
