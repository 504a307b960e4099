// Laws of angles from directions, attributes, fields and the neighbourhood.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "field/blend/angle/contact.h"
#include "field/blend/angle/directional_alpha.h"
#include "field/blend/angle/local_contact.h"
#include "field/kernel/inverse_family.h"
#include "field/program/field_program.h"
#include "tests/field/program_of.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::for_each_beside;
using test::numeric_gradient;
using test::program_of;
using test::Random;
using test::random_blend;
using test::relative;

// Eq. 15 as it stands, over pairs.
double over_pairs(const std::vector<Strand>& strands) {
  long double angles = 0, weights = 0;
  for (std::size_t i = 0; i < strands.size(); ++i)
    for (std::size_t j = 0; j < strands.size(); ++j) {
      if (i == j) continue;
      const Strand &a = strands[i], &b = strands[j];
      const double x = dot(a.direction, b.direction) / (length(a.direction) * length(b.direction));
      const double span = (a.bounds.most - a.bounds.least + b.bounds.most - b.bounds.least) / 2;
      const long double weight = static_cast<long double>(a.field) * b.field;
      angles += weight * (span * integer_power(x, 8) + (a.bounds.least + b.bounds.least) / 2);
      weights += weight;
    }
  return static_cast<double>(angles / weights);
}

TEST(DirectionalAlpha, IsTheSumOverPairsWithBoundsOfTheirOwn) {
  Random random(301);
  for (int i = 0; i < 200; ++i) {
    std::vector<Strand> strands(static_cast<std::size_t>(random.whole(2, 120)));
    for (Strand& s : strands) {
      s.field = exp(random.between(-30, 3));
      s.direction = random.vector(1);
      s.bounds = {random.between(-1, 0.5), random.between(0, 1.57)};
    }
    EXPECT_NEAR(directional_alpha(strands, false).value, over_pairs(strands), 3e-15);
  }
}

TEST(DirectionalAlpha, IsTheMostForParallelAndTheLeastForCrossingStrands) {
  std::vector<Strand> strands(2);
  strands[0] = {
      .field = 1, .field_gradient = {}, .direction = {2, 0, 0}, .direction_jacobian = {}, .bounds = {0.2, 1.3}};
  strands[1] = strands[0];
  strands[1].direction = {-5, 0, 0};  // orientation does not count
  EXPECT_NEAR(directional_alpha(strands, false).value, 1.3, 1e-15);
  strands[1].direction = {0, 1, 0};
  EXPECT_NEAR(directional_alpha(strands, false).value, 0.2, 1e-15);
  strands[1].direction = {1, 1, 0};
  EXPECT_NEAR(directional_alpha(strands, false).value, 0.2 + 1.1 / 16, 1e-15);  // cos^8 of 45 degrees
  strands[1].direction = {};
  EXPECT_NEAR(directional_alpha(strands, false).value, 0.2, 1e-15);
  strands.pop_back();
  EXPECT_EQ(directional_alpha(strands, true).value, 1.3);
  EXPECT_EQ(directional_alpha({}, true).value, 0);
}

// A blend of a few strands of two segments and of an arc, whose angles vary by one of the rules.
BlendField varying_blend(Random& random, int i) {
  const int n = random.whole(3, 7);
  BlendField blend = random_blend(random, n, 1, true, i % 2 ? Projection::Paper : Projection::Exact);
  if (i % 3 == 0) {
    blend.arcs.add(random.arc(), {});
    blend.points.strands = {0, 1};
    blend.segments.strands = {2, 2};
    blend.distance_segments.strands = {3};
    blend.arcs.strands = {4};
    for (int k = 0; k < 5; ++k) blend.direction_bounds.push_back({random.between(0, 1), random.between(0, 1.5)});
  } else if (i % 3 == 1) {
    blend.alpha_per_skeleton = true;
    blend.points.alphas = {random.between(0, 1.5), random.between(0, 1.5)};
    blend.segments.alphas = {random.between(0, 1.5), random.between(0, 1.5)};
    blend.segments.alphas_to = {random.between(0, 1.5), random.between(0, 1.5)};
    blend.distance_segments.alphas = {random.between(0, 1.5)};
  } else {
    static const LocalContact rules[] = {{Kernel{.degree = 4}, true, Projection::Paper, true, true},
                                         {Kernel{.degree = 5}, true, Projection::Exact, true, true}};
    const LocalContact& rule = rules[i % 2];
    blend.degree = i % 2 ? 5 : 4;
    blend.projection = i % 2 ? Projection::Exact : Projection::Paper;
    blend.distance_segments = {};
    blend.local_contact = std::make_shared<const LocalContact>(rule);
  }
  return blend;
}

TEST(AlphaRules, GradientsOfTheAngleAndOfTheCorrectedFieldAreTheDerivatives) {
  Random random(302);
  int checked[3] = {0, 0, 0};
  double worst = 0;
  for (int i = 0; i < 6000; ++i) {
    const BlendField blend = varying_blend(random, i);
    const Vec3d p = random.vector(2.5);
    const BlendSample s = evaluate(blend, p);
    EXPECT_EQ(s.corrected, corrected_value(blend, p));
    EXPECT_EQ(s.alpha, alpha_at(blend, p).value);
    if (s.corrected < 0.2 || s.corrected > 4) continue;
    const double step = 1e-4;
    double jump = 0;
    for_each_beside(p, 3 * step, [&](const Vec3d& q) {
      jump = std::max(jump, relative(evaluate(blend, q).corrected_gradient, s.corrected_gradient));
      jump = std::max(jump, length(alpha_at(blend, q).gradient - alpha_at(blend, p).gradient) * 0.2);
    });
    if (jump > 5e-3) continue;  // a seam of the operator or of a distance segment, or very near a skeleton
    const auto angle = [&](const Vec3d& q) { return alpha_at(blend, q).value; };
    EXPECT_LE(length(numeric_gradient(angle, p, step) - alpha_at(blend, p).gradient), 2e-6) << i;
    const auto value = [&](const Vec3d& q) { return corrected_value(blend, q); };
    const double error = relative(numeric_gradient(value, p, step), s.corrected_gradient);
    EXPECT_LE(error, 3e-6) << i << " n " << blend.degree << " alpha " << s.alpha;
    worst = std::max(worst, error);
    ++checked[i % 3];
  }
  std::cout << "  " << checked[0] << " by direction, " << checked[1] << " linear, " << checked[2]
            << " by neighbourhood, worst " << worst << '\n';
  for (const int count : checked) EXPECT_GT(count, 200);
}

Primitive with(auto skeleton) {
  Primitive p;
  p.skeleton = std::move(skeleton);
  return p;
}

// Angles that are linear along a segment do not change when it is cut; a curve interpolates them as its radius.
TEST(AlphaRules, LinearAnglesDoNotDependOnHowASegmentIsCut) {
  Random random(303);
  for (int i = 0; i < 200; ++i) {
    const Kernel kernel{i % 3 == 0 ? KernelFamily::Cauchy : KernelFamily::Inverse, random.whole(4, 8), 1.2};
    const SegmentSkeleton s = random.segment();
    const double cut = random.between(0.1, 0.9), radius = s.radius_from + (s.radius_to - s.radius_from) * cut;
    const double a = random.between(0, 1), b = random.between(0, 1);
    Primitive whole = with(s), other = with(random.point());
    Primitive parts =
        with(PolylineSkeleton{{s.from, lerp(s.from, s.to, cut), s.to}, {s.radius_from, radius, s.radius_to}});
    whole.attributes = {{"warmth", {a, b}}};
    parts.attributes = {{"warmth", {a, a + (b - a) * cut, b}}};
    other.attributes = {{"warmth", {0.5}}};
    const AlphaAttribute rule{"warmth", AlphaRamp{{-1, 2}, {0, 1.5}}};
    const FieldProgram first = program_of({whole, other}, rule, {}, kernel);
    const FieldProgram second = program_of({parts, other}, rule, {}, kernel);
    const Vec3d p = random.vector(2.5);
    EXPECT_NEAR(alpha_at(first.parts()[0].blend, p).value, alpha_at(second.parts()[0].blend, p).value, 1e-12);
  }
}

TEST(AlphaRules, AttributesAreAnglesAndTheRadiusIsOne) {
  Primitive thick = with(PointSkeleton{{0, 0, 0}, 1}), thin = with(PointSkeleton{{5, 0, 0}, 0.1});
  const FieldProgram by_radius = program_of({thick, thin}, AlphaAttribute{"radius", AlphaRamp{{0.1, 1}, {0.2, 1.2}}});
  EXPECT_EQ(by_radius.parts()[0].blend.points.alphas, (std::vector<double>{1.2, 0.2}));
  thick.attributes = {{"angle", {0.7}}};
  const FieldProgram by_name = program_of({thick, thin}, AlphaAttribute{"angle", {}});
  EXPECT_EQ(by_name.parts()[0].blend.points.alphas, (std::vector<double>{0.7, contact_alpha(4)}));
}

TEST(AlphaRules, PolylinesAndCurvesAreStrandsAndMayHaveBounds) {
  Primitive line = with(PolylineSkeleton{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {0.2, 0.2, 0.2}});
  line.alpha_bounds = {0.1, 0.9};
  const FieldProgram program = program_of({line, with(PointSkeleton{}), line}, AlphaDirection{0.3, 1.2});
  const BlendField& blend = program.parts()[0].blend;
  EXPECT_EQ(blend.segments.strands, (std::vector<std::uint32_t>{0, 0, 2, 2}));
  EXPECT_EQ(blend.points.strands, std::vector<std::uint32_t>{1});
  EXPECT_EQ(blend.direction_bounds, (std::vector<DirectionBounds>{{0.1, 0.9}, {0.3, 1.2}, {0.1, 0.9}}));
}

// Two parallel hairs whose surfaces overlap blend more than two crossing ones at the same distance.
TEST(AlphaRules, ParallelHairsBlendAndCrossingOnesDoNot) {
  const auto middle_of = [](const Vec3d& other) {
    const FieldProgram program =
        program_of({with(SegmentSkeleton{{-9, 0, 0}, {9, 0, 0}, 0.5, 0.5}),
                    with(SegmentSkeleton{Vec3d{0, 0, 1.05} - other, Vec3d{0, 0, 1.05} + other, 0.5, 0.5})},
                   AlphaDirection{0.3, std::numbers::pi / 2});
    return value(program, {0, 0, 0.525});
  };
  EXPECT_GT(middle_of({9, 0, 0}), 1);
  EXPECT_LT(middle_of({0, 9, 0}), 1);
}

TEST(AlphaRules, AFieldSteersTheBlendInItsPlacement) {
  const auto at = [](const Affine& map, const Vec3d& p) {
    FieldDescription description;
    const FieldNodeId heat = description.add({.what = with(PointSkeleton{{2, 0, 0}, 1}), .where = {}});
    Blend blend;
    blend.alpha = AlphaFromField{heat, AlphaRamp{{0.1, 0.9}, {0.2, 1.4}}};
    blend.of = {description.add({.what = with(PointSkeleton{{0, 0, 0}, 1}), .where = {}}),
                description.add({.what = with(PointSkeleton{{2.1, 0, 0}, 1}), .where = {}})};
    const FieldNodeId root = description.add({.what = blend, .where = {}});
    description.root = description.add({.what = Transform{map, root}, .where = {}});
    const auto program = compile(description);
    EXPECT_TRUE(program);
    return evaluate_part(program->parts()[0], p);
  };
  const Vec3d p{1, 0.4, 0.2};
  const BlendSample plain = at(Affine{}, p);
  const double f = std::sqrt(1 / length_squared(p - Vec3d{2, 0, 0})), heat = f * f * f;
  EXPECT_NEAR(plain.alpha, 0.2 + 1.2 * (heat - 0.1) / 0.8, 1e-14);
  for (const Vec3d& scale : {Vec3d{2, 2, 2}, Vec3d{2, 1, 0.5}}) {
    const Affine map = Affine::translate({1, 2, 3}) * Affine::scale(scale);
    EXPECT_NEAR(at(map, map.point(p)).alpha, plain.alpha, 1e-14);
    EXPECT_NEAR(at(map, map.point(p)).corrected, plain.corrected, 1e-13);
  }
}

TEST(AlphaRules, RefusesAFieldOfAnglesWithinAnother) {
  FieldDescription description;
  Blend heat;
  heat.of = {description.add({.what = with(PointSkeleton{}), .where = {}})};
  heat.alpha = AlphaFromField{heat.of.front(), {}};
  const FieldNodeId inner = description.add({.what = heat, .where = {}});
  Blend blend;
  blend.of = {heat.of.front()};
  blend.alpha = AlphaFromField{inner, {}};
  description.root = description.add({.what = blend, .where = {}});
  EXPECT_FALSE(compile(description));
}

// Where along the line of the centres two balls join, as a share of the sum of their radii.
double joining_distance(BlendField blend, double ratio) {
  const auto joined = [&](double distance) {
    blend.points = {};
    blend.points.add({{0, 0, 0}, 1}, {});
    blend.points.add({{distance, 0, 0}, ratio}, {});
    double least = 1e9;
    for (int i = 0; i <= 1600; ++i) {
      const double u = -0.85 + 1.7 * i / 1600.0, at = u * std::fabs(u);
      least = std::min(least, corrected_value(blend, {1 + (at < 0 ? at : at * ratio), 0, 0}));
    }
    return least >= 1;
  };
  double low = 0.9 * (1 + ratio), high = 1.1 * (1 + ratio);
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    (joined(middle) ? low : high) = middle;
  }
  return low / (1 + ratio);
}

TEST(LocalContact, JoinsUnequalBallsWhenTheyTouch) {
  const double late[3][3] = {{0.9953, 0.9810, 0.9643}, {0.9972, 0.9887, 0.9789}, {0.9981, 0.9925, 0.9861}};
  const double ratios[] = {0.5, 0.2, 0.05};
  for (int n = 3; n <= 5; ++n)
    for (int k = 0; k < 3; ++k) {
      BlendField blend;
      blend.degree = n;
      blend.alpha = contact_alpha(n);
      EXPECT_NEAR(joining_distance(blend, ratios[k]), late[n - 3][k], 2e-4)
          << n << ' ' << ratios[k];  // recomputed in 40 digits
      blend.local_contact =
          std::make_shared<const LocalContact>(Kernel{.degree = n}, true, Projection::Paper, true, false);
      const double joined = joining_distance(blend, ratios[k]);
      std::cout << "  n " << n << " ratio " << ratios[k] << ": " << joined << '\n';
      EXPECT_NEAR(joined, 1, ratios[k] < 0.1 ? 2e-3 : 2e-4) << n << ' ' << ratios[k];
    }
}

TEST(LocalContact, AdaptsToRadiiUnderEveryKernel) {
  for (const Kernel& kernel : {Kernel{KernelFamily::Cauchy, 4, 1.2}, Kernel{KernelFamily::Compact, 4, 1.5}}) {
    BlendField blend;
    blend.kernel = kernel.family;
    blend.kernel_shape = kernel.shape;
    blend.degree = kernel.degree;
    blend.alpha = contact_alpha(kernel);
    const double late = joining_distance(blend, 0.4);
    blend.local_contact = std::make_shared<const LocalContact>(kernel, true, Projection::Paper, true, false);
    const double joined = joining_distance(blend, 0.4);
    std::cout << "  contact " << late << ", adapted " << joined << '\n';
    EXPECT_LT(late, 0.998);
    EXPECT_NEAR(joined, 1, 2e-3);
  }
}

// Where contact comes near to it the table's cubics would go beyond, where the operator is not defined.
TEST(LocalContact, IsNeverWiderThanThePlainSum) {
  for (const double support : {1.5, 2.0, 2.2}) {
    const LocalContact rule(Kernel{KernelFamily::Compact, 5, support}, true, Projection::Paper, true, false);
    EXPECT_LE(rule.range().hi, std::numbers::pi / 2);
    for (int i = 0; i <= 2000; ++i) {
      const double spread = 0.005 * i;
      Neighbourhood place;
      place.field = 1;
      place.spread = spread;
      const double alpha = rule.at(place).value;
      EXPECT_LE(alpha, std::numbers::pi / 2) << support << " " << spread;
      EXPECT_TRUE(rule.within({spread, spread}, 1).alpha.contains(alpha)) << support << " " << spread;
    }
  }
}

TEST(LocalContact, IsContactForEqualSkeletonsAndClosesTheTorusWhenItTouchesItself) {
  for (int n = 3; n <= 6; ++n) {
    BlendField blend;
    blend.degree = n;
    blend.local_contact =
        std::make_shared<const LocalContact>(Kernel{.degree = n}, true, Projection::Paper, true, true);
    blend.points.add({{-1, 0, 0}, 1}, {});
    blend.points.add({{1, 0, 0}, 1}, {});
    EXPECT_NEAR(alpha_at(blend, {0, 0, 0}).value, contact_alpha(n), 1e-12) << n;
    EXPECT_NEAR(corrected_value(blend, {0, 0, 0}), 1, 1e-12) << n;
    EXPECT_NEAR(alpha_at(blend, {-1, 0.9, 0}).value, contact_alpha(n), 1e-3) << n;
    blend.points = {};
    blend.arcs.add(ArcSkeleton{}, {});
    const double keys[] = {-0.492978071, -0.745484658, -0.858572351, -0.925006348};  // recomputed in 40 digits
    EXPECT_NEAR(alpha_at(blend, {0, 0, 0}).value, keys[n - 3], 1e-8) << n;
    EXPECT_NEAR(corrected_value(blend, {0, 0, 0}), 1, 1e-9) << n;
    blend.arcs.skeletons[0].radius_from = blend.arcs.skeletons[0].radius_to = 0.97;
    EXPECT_LT(corrected_value(blend, {0, 0, 0}), 1) << n;
    blend.arcs.skeletons[0].radius_from = blend.arcs.skeletons[0].radius_to = 1.03;
    EXPECT_GT(corrected_value(blend, {0, 0, 0}), 1) << n;
  }
}

}  // namespace
}  // namespace marrow
