// What is linear along a skeleton, and the directions of arcs: parts against wholes, and derivatives.
#include "field/skeleton/shares.h"

#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "field/blend/curvature.h"
#include "field/program/field_program.h"
#include "field/skeleton/second_order.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"
#include "tests/field/random_kernel.h"

namespace marrow {
namespace {

using test::numeric_gradient;
using test::Random;
using test::random_kernel;
using test::relative;

struct Sums {
  double share = 0;
  Vec3d direction{};
};

// Of short segments in place of the arc.
Sums of_chords(const ArcSkeleton& arc, const Vec3d& p, const Kernel& kernel, int count) {
  const auto joint = [&](int i) {
    const double share = i / static_cast<double>(count);
    const auto [sine, cosine] = sincos(arc.begin + (arc.end - arc.begin) * share);
    return PointSkeleton{arc.center + (arc.axis1 * cosine + arc.axis2 * sine) * arc.major,
                         arc.radius_from + (arc.radius_to - arc.radius_from) * share};
  };
  Sums sums;
  for (int i = 0; i < count; ++i) {
    const PointSkeleton a = joint(i), b = joint(i + 1);
    const SegmentSkeleton chord{a.at, b.at, a.radius, b.radius};
    const double f = segment_field<Derivatives::ScaleInvariant>(chord, p, kernel).value;
    sums.share += (f * i + segment_share(chord, p, kernel).value) / count;
    sums.direction += normalize(chord.to - chord.from).vec() * f;
  }
  return sums;
}

TEST(Shares, AnArcIsManyShortSegments) {
  Random random(20261123);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const Kernel kernel = random_kernel(random, i, 8);
    const ArcSkeleton arc = random.arc();
    const Vec3d p = random.vector(2);
    const double f = arc_field<Derivatives::ScaleInvariant>(arc, p, kernel).value;
    if (!(f > 1e-3) || f > 5) continue;
    const Sums few = of_chords(arc, p, kernel, 150), many = of_chords(arc, p, kernel, 300);
    const auto limit = [](const auto& coarse, const auto& fine) { return (fine * 4.0 - coarse) * (1.0 / 3); };
    EXPECT_NEAR(integral_shares(arc, p, kernel)[0].value, limit(few.share, many.share), 2e-6 * f);
    EXPECT_LE(length(arc_direction(arc, p, kernel).value - limit(few.direction, many.direction)), 2e-6 * f);
  }
}

TEST(Shares, OfTheCornersOfATriangleSumToItsField) {
  Random random(20261124);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const Kernel kernel = random_kernel(random, i, 8);
    const TriangleSkeleton t = random.triangle();
    const TriangleSkeleton turned{{t.vertices[1], t.vertices[2], t.vertices[0]}, {t.radii[1], t.radii[2], t.radii[0]}};
    const Vec3d p = random.vector(2);
    const double f = triangle_field<Derivatives::ScaleInvariant>(t, p, kernel).value;
    if (!(f > 1e-3) || f > 5) continue;
    const Shares two = integral_shares(t, p, kernel), other = integral_shares(turned, p, kernel);
    EXPECT_NEAR(two[0].value + two[1].value + other[1].value, f, 1e-10 * f);
    EXPECT_NEAR(other[0].value, two[1].value, 1e-10 * f);
    for (const ShareSample& share : two) EXPECT_GT(share.value, 0);
  }
}

double magnitude(const Matrix3& m) { return length(m.rows[0]) + length(m.rows[1]) + length(m.rows[2]); }

struct Checks {
  int done = 0, rough = 0;
};

// first(q) gives a ShareSample; its gradient against differences of its value, the jet against those of its gradient.
void expect_derivatives(const auto& first, const HessianJet& jet, const Vec3d& p, double size, Checks& checks) {
  const ShareSample here = first(p);
  EXPECT_NEAR(jet.value, here.value, 1e-9 * size);
  EXPECT_LE(length(gradient_of(jet) - here.gradient), 1e-7 * (size + length(here.gradient)));
  const auto slopes = [&](double h) { return numeric_gradient([&](const Vec3d& q) { return first(q).value; }, p, h); };
  const auto rows = [&](double h) {
    Matrix3 m;
    for (std::size_t k = 0; k < 3; ++k)
      m.rows[k] = numeric_gradient([&](const Vec3d& q) { return first(q).gradient[k]; }, p, h);
    return m;
  };
  const Vec3d near = slopes(1e-4), wide = slopes(2e-4);
  const Matrix3 near_rows = rows(1e-4), wide_rows = rows(2e-4);
  const double scale = magnitude(near_rows) + length(near) + size, change = magnitude(near_rows + wide_rows * -1.0);
  ++checks.done;
  if (!(change < 1e-3 * scale)) return void(++checks.rough);  // another place is nearest, or the edge of a support
  EXPECT_LE(length(near - here.gradient), length(near - wide) + 1e-7 * scale);
  EXPECT_LE(magnitude(near_rows + hessian_of(jet) * -1.0), change + 1e-6 * scale);
}

// Plain shares by distance are weighted; so are the jets here.
template <class Skeleton>
void expect_shares(const Skeleton& s, const Vec3d& p, const Kernel& kernel, Checks& checks) {
  const auto by_distance = [&](const Vec3d& q) { return distance_field<Derivatives::First>(s, q, kernel); };
  const SecondOrderSample f = second_order(s, p, kernel), g = second_order_by_distance(s, p, kernel);
  const SecondOrderShares shares = second_order_shares(s, p, kernel), nearest = second_order_nearest_shares(s, p);
  for (std::size_t k = 0; k < 2; ++k) {
    if (f.field.value > 1e-3 && f.field.value < 5)
      expect_derivatives([&](const Vec3d& q) { return integral_shares(s, q, kernel)[k]; }, shares[k], p, f.field.value,
                         checks);
    if (g.field.value > 1e-3 && g.field.value < 5)
      expect_derivatives([&](const Vec3d& q) { return nearest_shares(s, q, by_distance(q))[k]; }, g.field * nearest[k],
                         p, g.field.value, checks);
  }
}

TEST(Shares, AndDirectionsHaveTheirDerivatives) {
  Random random(20261125);
  Checks checks;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const Kernel kernel = random_kernel(random, i, 8);
    const Vec3d p = random.vector(2);
    const SegmentSkeleton segment = random.segment();
    expect_shares(segment, p, kernel, checks);
    if (i % 3 != 2 || i < 12) expect_shares(random.triangle(), p, kernel, checks);
    const ArcSkeleton arc = random.arc();
    expect_shares(arc, p, kernel, checks);
    const auto foot = [&](const Vec3d& q) { return foot_shares(segment, q, {.value = 1})[0]; };
    expect_derivatives(foot, second_order_foot_shares(segment, p)[0], p, 1, checks);
    const double f = arc_field<Derivatives::ScaleInvariant>(arc, p, kernel).value;
    const SecondOrderSample g = second_order_by_distance(arc, p, kernel);
    const Vec3<HessianJet> u = second_order_direction(arc, p, kernel), v = second_order_nearest_direction(arc, p);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto part = [&](const DirectionSample& d) { return ShareSample{d.value[c], d.jacobian.rows[c]}; };
      const auto by_distance = [&](const Vec3d& q) { return distance_field<Derivatives::First>(arc, q, kernel); };
      if (f > 1e-3 && f < 5)
        expect_derivatives([&](const Vec3d& q) { return part(arc_direction(arc, q, kernel)); }, u[c], p, f, checks);
      if (g.field.value > 1e-3 && g.field.value < 5)
        expect_derivatives([&](const Vec3d& q) { return part(nearest_direction(arc, q, by_distance(q))); },
                           g.field * v[c], p, g.field.value, checks);
    }
  }
  std::cout << "  " << checks.done << " fields, " << checks.rough << " at kinks\n";
  EXPECT_GT(checks.done, 400);
  EXPECT_LT(checks.rough, checks.done / 5);
}

// An attribute that rises along a polyline does not jump from segment to segment under the distance model.
TEST(Shares, AnAttributeIsContinuousByDistance) {
  Primitive line;
  line.skeleton = PolylineSkeleton{{{-1, 0.2, 0}, {0, 0, 0}, {1, 0.4, 0.1}}, {0.3, 0.3, 0.3}};
  line.attributes = {{"warmth", {0.2, 0.6, 1.4}}};
  line.model = SkeletonModel::Distance;
  FieldDescription description;
  Blend blend;
  blend.alpha = AlphaAttribute{"warmth", {}};
  blend.of.push_back(description.add({.what = line, .where = {}}));
  description.root = description.add({.what = blend, .where = {}});
  const auto program = compile(description);
  ASSERT_TRUE(program);
  const auto alpha = [&](double x) { return evaluate_part(program->parts()[0], {x, -0.3, 0.05}).alpha; };
  EXPECT_NEAR(alpha(0.05), 0.6, 0.1);
  for (double x = -0.9; x < 0.9; x += 1e-3) EXPECT_LT(std::fabs(alpha(x + 1e-3) - alpha(x)), 3e-3) << x;
}

}  // namespace
}  // namespace marrow
