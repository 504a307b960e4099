// Laws of the smallest scaled distance under every kernel, and of the segment of Cani and Hornus.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include <gtest/gtest.h>

#include "field/kernel/profile.h"
#include "field/program/field_program.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/program_of.h"
#include "tests/field/random.h"
#include "tests/field/random_kernel.h"
#include "tests/field/ring_of.h"

namespace marrow {
namespace {

using test::numeric_gradient;
using test::Random;
using test::random_kernel;
using test::relative;
using test::ring_of;

constexpr auto second = Derivatives::Second;

// The largest kernel value over many places of a skeleton: below the field, and near it.
template <class PlaceAt>
double brute(const PlaceAt& place_at, const Vec3d& p, const Kernel& kernel) {
  const Profile profile(kernel, 0);
  double least = std::numeric_limits<double>::infinity();
  constexpr int parts = 160;
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; j <= parts; ++j) {
      const PointSkeleton q = place_at(i / double{parts}, j / double{parts});
      least = std::min(least, length_squared(p - q.at) / (q.radius * q.radius));
    }
  return profile.at(least).value / profile.normalisation();
}

PointSkeleton place_on(const TriangleSkeleton& t, double s, double u) {
  const double a = s, b = (1 - s) * u, c = 1 - a - b;
  return {t.vertices[0] * a + t.vertices[1] * b + t.vertices[2] * c, t.radii[0] * a + t.radii[1] * b + t.radii[2] * c};
}
PointSkeleton place_on(const ArcSkeleton& arc, double s, double u) {
  const double share = (s * 160 + u) / 161, angle = arc.begin + (arc.end - arc.begin) * share;
  const auto [sine, cosine] = sincos(angle);
  return {arc.center + (arc.axis1 * cosine + arc.axis2 * sine) * arc.major,
          arc.radius_from + (arc.radius_to - arc.radius_from) * share};
}

TEST(DistanceField, IsTheLargestKernelOverTheSkeleton) {
  Random random(401);
  for (int i = 0; i < 90; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const TriangleSkeleton t = random.triangle();
    const ArcSkeleton arc = random.arc();
    const Vec3d p = random.vector(2.5);
    const auto check = [&](double field, double dense) {
      EXPECT_GE(field, dense * (1 - 1e-9));
      EXPECT_NEAR(field, dense, 0.03 * field + 2e-3) << i;
    };
    check(distance_field<second>(t, p, kernel).value,
          brute([&](double s, double u) { return place_on(t, s, u); }, p, kernel));
    check(distance_field<second>(arc, p, kernel).value,
          brute([&](double s, double u) { return place_on(arc, s, u); }, p, kernel));
  }
}

template <class Skeleton>
int check_derivatives(const Skeleton& skeleton, const Vec3d& p, const Kernel& kernel) {
  const auto at = [&](const Vec3d& q) { return distance_field<second>(skeleton, q, kernel); };
  const SkeletonSample s = at(p);
  if (!(s.value > 0.02 && s.value < 20)) return 0;
  double magnitude = 0;
  for (const Vec3d& row : s.si_jacobian.rows) magnitude += length(row);
  // only where no end, edge or other nearest place takes over within the differences
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double side : {-4e-4, 4e-4}) {
      Vec3d q = p;
      q[axis] += side;
      double jump = 0;
      const SkeletonSample other = at(q);
      for (std::size_t k = 0; k < 3; ++k) jump += length(other.si_jacobian.rows[k] - s.si_jacobian.rows[k]);
      if (jump > 3e-2 * magnitude) return 0;
    }
  EXPECT_LE(relative(numeric_gradient([&](const Vec3d& q) { return at(q).value; }, p, 2e-4), s.gradient), 1e-6);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto component = [&](const Vec3d& q) { return at(q).si_gradient[k]; };
    EXPECT_LE(length(numeric_gradient(component, p, 2e-4) - s.si_jacobian.rows[k]), 1e-5 * magnitude);
  }
  return 1;
}

TEST(DistanceField, GradientsAndJacobianAreTheDerivatives) {
  Random random(402);
  int segments = 0, triangles = 0, arcs = 0;
  for (int i = 0; i < 1500; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const Vec3d p = random.vector(2);
    segments += check_derivatives(random.segment(), p, kernel);
    triangles += check_derivatives(random.triangle(), p, kernel);
    arcs += check_derivatives(random.arc(), p, kernel);
  }
  std::cout << "  " << segments << " segments, " << triangles << " triangles, " << arcs << " arcs\n";
  for (const int count : {segments, triangles, arcs}) EXPECT_GT(count, 300);
}

// On the reference curve, whatever the shape: |grad_S f| is that of a point with the same field.
TEST(DistanceField, LiesOnTheReferenceCurve) {
  Random random(403);
  for (int i = 0; i < 600; ++i) {
    const Kernel kernel = random_kernel(random, i);
    const SkeletonSample s = i % 2 ? distance_field<second>(random.triangle(), random.vector(2), kernel)
                                   : distance_field<second>(random.arc(), random.vector(2), kernel);
    if (!(s.value > 1e-3 && s.value < 10)) continue;
    double near = 1e-3, far = 20;
    const auto point = [&](double x) {
      const PointSkeleton ball{{0, 0, 0}, 1};
      return kernel.family == KernelFamily::Inverse ? point_field<second>(ball, {x, 0, 0}, kernel.degree)
                                                    : point_field<second>(ball, {x, 0, 0}, kernel);
    };
    for (int step = 0; step < 60; ++step) {
      const double middle = (near + far) / 2;
      (point(middle).value > s.value ? near : far) = middle;
    }
    EXPECT_LE(relative(length(point(near).si_gradient), length(s.si_gradient)), 1e-7);
  }
}

TEST(DistanceField, SegmentsAgreeWithTheirOwnForm) {
  Random random(404);
  for (int i = 0; i < 500; ++i) {
    const SegmentSkeleton s = random.segment();
    const Vec3d p = random.vector(2);
    const int n = random.whole(3, 8);
    const SkeletonSample a = distance_field<second>(s, p, Kernel{.degree = n}),
                         b = distance_segment_field<second>(s, p, n);
    EXPECT_LE(relative(a.value, b.value), 1e-12);
    EXPECT_LE(relative(a.gradient, b.gradient), 1e-12);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LE(length(a.si_jacobian.rows[k] - b.si_jacobian.rows[k]),
                1e-9 * (length(b.si_jacobian.rows[0]) + length(b.si_jacobian.rows[1]) + length(b.si_jacobian.rows[2])));
  }
}

FieldProgram program_of(const Primitive& primitive, const Kernel& kernel) {
  return test::program_of({primitive}, AlphaSum{}, {}, kernel);
}

// A polyline is one primitive: it has no bulge where its segments meet, and its surface is its radius away.
TEST(DistanceField, APolylineIsOnePrimitive) {
  for (int i = 0; i < 3; ++i) {
    Random random(405);
    const Kernel kernel = random_kernel(random, i);
    Primitive line;
    line.skeleton = PolylineSkeleton{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}}, {0.5, 0.5, 0.5, 0.5}};
    line.model = SkeletonModel::Distance;
    const FieldProgram program = program_of(line, kernel);
    for (const Vec3d& p : {Vec3d{0.4, 0.3, 0.4}, Vec3d{1, 0.3, 0.4}, Vec3d{2, -0.3, 0.4}, Vec3d{-0.5, 0, 0}})
      EXPECT_NEAR(value(program, p), 1, 1e-13);
  }
}

TEST(DistanceField, EverySkeletonTakesIt) {
  for (int i = 0; i < 3; ++i) {
    Random random(406);
    const Kernel kernel = random_kernel(random, i);
    Primitive triangle, circle;
    triangle.skeleton = TriangleSkeleton{{Vec3d{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {0.3, 0.3, 0.3}};
    circle.skeleton = ring_of(2, 0.3);
    triangle.model = circle.model = SkeletonModel::Distance;
    EXPECT_NEAR(value(program_of(triangle, kernel), {1, 1, 0.3}), 1, 1e-13);
    EXPECT_NEAR(value(program_of(triangle, kernel), {1, -0.3, 0}), 1, 1e-13);
    EXPECT_NEAR(value(program_of(circle, kernel), {0, 2, 0.3}), 1, 1e-13);
    EXPECT_NEAR(value(program_of(circle, kernel), {-1.7, 0, 0}), 1, 1e-13);
    EXPECT_NEAR(value(program_of(circle, kernel), {0, 0, 0}), value(program_of(circle, kernel), {1e-9, 0, 0}),
                1e-7);  // on the axis all places are near
  }
}

TEST(CaniHornus, IsTheIntegralForOneRadiusAndHasTheValuesOfTheStudyForOthers) {
  Random random(411);
  for (int i = 0; i < 200; ++i) {
    SegmentSkeleton s = random.segment();
    s.radius_to = s.radius_from;
    const Vec3d p = random.vector(2);
    EXPECT_LE(relative(cani_hornus_field<second>(s, p).value, segment_field<second>(s, p, 3).value), 1e-13);
  }
  // A segment of length 10 and slope 0.15, at its middle and near its end
  const SegmentSkeleton s{{0, 0, 0}, {10, 0, 0}, 0.25, 1.75};
  EXPECT_NEAR(cani_hornus_field<second>(s, {5, 1, 0}).value, 0.9806, 5e-5);
  EXPECT_NEAR(segment_field<second>(s, {5, 1, 0}, 3).value, 1.0106, 5e-3);
}

TEST(CaniHornus, GradientsAndJacobianAreTheDerivatives) {
  Random random(412);
  int checked = 0;
  for (int i = 0; i < 800; ++i) {
    const SegmentSkeleton s = random.segment();
    const Vec3d p = random.vector(2);
    const double foot = dot(p - s.from, s.to - s.from) / length_squared(s.to - s.from);
    const SkeletonSample sample = cani_hornus_field<second>(s, p);
    if (std::fabs(foot) < 1e-2 || std::fabs(foot - 1) < 1e-2 || sample.value > 20) continue;
    const auto at = [&](const Vec3d& q) { return cani_hornus_field<second>(s, q); };
    EXPECT_LE(relative(numeric_gradient([&](const Vec3d& q) { return at(q).value; }, p, 1e-4), sample.gradient), 1e-6);
    double magnitude = 0;
    for (const Vec3d& row : sample.si_jacobian.rows) magnitude += length(row);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component = [&](const Vec3d& q) { return at(q).si_gradient[k]; };
      EXPECT_LE(length(numeric_gradient(component, p, 1e-4) - sample.si_jacobian.rows[k]), 1e-5 * magnitude);
    }
    ++checked;
  }
  EXPECT_GT(checked, 400);
}

TEST(CaniHornus, BelongsToTheKernelInverseThree) {
  Primitive segment;
  segment.skeleton = SegmentSkeleton{{0, 0, 0}, {1, 0, 0}, 0.5, 0.3};
  segment.model = SkeletonModel::CaniHornus;
  const auto compiled = [&](const Kernel& kernel, const Primitive& primitive) {
    FieldDescription description;
    Blend blend;
    blend.kernel = kernel;
    blend.alpha = AlphaSum{};
    blend.of = {description.add({.what = primitive, .where = {}})};
    description.root = description.add({.what = blend, .where = {}});
    return static_cast<bool>(compile(description));
  };
  EXPECT_TRUE(compiled({.degree = 3}, segment));
  EXPECT_FALSE(compiled({.degree = 4}, segment));
  EXPECT_FALSE(compiled({KernelFamily::Cauchy, 3, 1}, segment));
  segment.skeleton = ArcSkeleton{};
  EXPECT_FALSE(compiled({.degree = 3}, segment));
}

}  // namespace
}  // namespace marrow
