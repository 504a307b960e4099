// Laws of the projection angle that varies from place to place.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "field/blend/angle/contact.h"
#include "field/blend/angle/local_contact.h"
#include "field/program/field_program.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::for_each_beside;
using test::mirrored_blend;
using test::numeric_gradient;
using test::Random;
using test::random_blend;
using test::relative;

void give_angles(BlendField& blend, Random& random, double least) {
  blend.alpha_per_skeleton = true;
  const auto fill = [&](auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i) list.alphas.push_back(random.between(least, std::numbers::pi / 2));
  };
  fill(blend.points);
  fill(blend.segments);
  fill(blend.distance_segments);
}

TEST(Alpha, SlopeOfTheCorrectionIsTheDerivativeInEveryBranch) {
  Random random(71);
  int checked = 0, in_branch = 0;
  double worst = 0;
  for (int i = 0; i < 6000; ++i) {
    const int n = random.whole(3, 8);
    const bool cavity = i % 3 != 0;
    const Projection projection = i % 2 ? Projection::Paper : Projection::Exact;
    const double f = random.between(0.2, 4), G = ReferenceCurve(n).at(f) * random.between(0, 1.5);
    const double alpha = random.between(i % 4 == 1 ? -0.5 : 0.01, 1.55), step = 1e-5;
    const auto at = [&](double a) { return Correction(n, a, cavity, projection); };
    if (alpha < 0 && projection == Projection::Exact) continue;
    const Correction::Partials c = at(alpha).partials(f, G);
    const bool branch = at(alpha).in_cavity_branch(f, G);
    // C is continuous but not smooth where the branch, or the guard of negative angles, begins
    if (at(alpha - step).in_cavity_branch(f, G) != branch || at(alpha + step).in_cavity_branch(f, G) != branch)
      continue;
    const double before = at(alpha - step).partials(f, G).dalpha, after = at(alpha + step).partials(f, G).dalpha;
    if (std::fabs(after - before) > 1e-3 * (std::fabs(c.dalpha) + 0.1)) continue;
    const double numeric = (at(alpha + step).value(f, G) - at(alpha - step).value(f, G)) / (2 * step);
    const double error = std::fabs(numeric - c.dalpha) / (std::fabs(c.dalpha) + 0.1);
    EXPECT_LE(error, 1e-6) << "n " << n << " alpha " << alpha << " f " << f << " G " << G << " branch " << branch;
    worst = std::max(worst, error);
    ++checked;
    in_branch += branch;
  }
  std::cout << "  " << checked << " places, " << in_branch << " in the cavity branch, worst " << worst << '\n';
  EXPECT_GT(checked, 4000);
  EXPECT_GT(in_branch, 200);
}

TEST(Alpha, GradientIsTheDerivativeOfTheFieldWithAnglesPerSkeleton) {
  Random random(72);
  int checked = 0, in_branch = 0;
  double worst = 0;
  for (int i = 0; i < 4000; ++i) {
    const int n = random.whole(3, 7);
    const Vec3d center = random.vector(2.5), p = center + random.vector(0.1);
    const Projection projection = i % 2 ? Projection::Paper : Projection::Exact;
    BlendField blend = i % 4 < 2 ? random_blend(random, n, 1, true, projection)
                                 : mirrored_blend(random, center, n, 1, true, projection);
    give_angles(blend, random, 0);
    const BlendSample s = evaluate(blend, p);
    if (s.corrected < 0.2 || s.corrected > 6) continue;
    EXPECT_EQ(s.corrected, corrected_value(blend, p));
    EXPECT_EQ(s.alpha, alpha_at(blend, p).value);
    const double step = 1e-4;
    double jump = 0;
    for_each_beside(p, 3 * step, [&](const Vec3d& q) {
      jump = std::max(jump, relative(evaluate(blend, q).corrected_gradient, s.corrected_gradient));
    });
    if (jump > 5e-3) continue;
    const auto value = [&](const Vec3d& q) { return corrected_value(blend, q); };
    const auto angle = [&](const Vec3d& q) { return alpha_at(blend, q).value; };
    EXPECT_LE(length(numeric_gradient(angle, p, step) - alpha_at(blend, p).gradient), 1e-6);
    const double error = relative(numeric_gradient(value, p, step), s.corrected_gradient);
    EXPECT_LE(error, 2e-6) << "n " << n << " alpha " << s.alpha;
    worst = std::max(worst, error);
    ++checked;
    in_branch += Correction(n, s.alpha, true, projection).in_cavity_branch(s.sum, s.si_norm);
  }
  std::cout << "  " << checked << " places, " << in_branch << " in the cavity branch, worst " << worst << '\n';
  EXPECT_GT(checked, 500);
  EXPECT_GT(in_branch, 50);
}

TEST(Alpha, EqualAnglesAreOneAngleAndOthersLieBetweenTheLeastAndTheLargest) {
  Random random(73);
  for (int i = 0; i < 200; ++i) {
    BlendField blend = random_blend(random, 4, 0.8, true, Projection::Paper), same = blend;
    const Vec3d p = random.vector(3);
    same.alpha_per_skeleton = true;
    same.points.alphas.assign(same.points.size(), 0.8);
    same.segments.alphas.assign(same.segments.size(), 0.8);
    same.distance_segments.alphas.assign(same.distance_segments.size(), 0.8);
    EXPECT_LE(relative(corrected_value(blend, p), corrected_value(same, p)), 1e-13);
    give_angles(blend, random, -1);
    std::vector<double> all = blend.points.alphas;
    all.insert(all.end(), blend.segments.alphas.begin(), blend.segments.alphas.end());
    all.insert(all.end(), blend.distance_segments.alphas.begin(), blend.distance_segments.alphas.end());
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    const double alpha = alpha_at(blend, p).value;
    EXPECT_TRUE(alpha >= *low - 1e-15 && alpha <= *high + 1e-15);
  }
}

TEST(Alpha, IsTheBlendsOwnWhereTheSumIsZeroOrInfinite) {
  BlendField blend;
  blend.alpha = 0.7;
  blend.alpha_per_skeleton = true;
  EXPECT_EQ(evaluate(blend, {}).alpha, 0.7);
  blend.points.add({{0, 0, 0}, 1}, {});
  blend.points.alphas = {0.2};
  EXPECT_EQ(evaluate(blend, {}).alpha, 0.7);
  EXPECT_EQ(evaluate(blend, {}).corrected_gradient, Vec3d{});
  EXPECT_NEAR(evaluate(blend, {1, 2, 3}).alpha, 0.2, 1e-15);
}

TEST(Alpha, PerSkeletonCompilesWithContactForThoseWithout) {
  FieldDescription description;
  Primitive with, without;
  with.skeleton = PointSkeleton{{0, 0, 0}, 1};
  with.alpha = 0.3;
  without.skeleton = PolylineSkeleton{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {1, 1, 1}};
  Blend blend;
  blend.alpha = AlphaPerSkeleton{};
  blend.of = {description.add({.what = with, .where = {}}), description.add({.what = without, .where = {}})};
  description.root = description.add({.what = blend, .where = {}});
  const auto program = compile(description);
  ASSERT_TRUE(program);
  const BlendField& field = program->parts()[0].blend;
  EXPECT_EQ(field.points.alphas, std::vector<double>{0.3});
  EXPECT_EQ(field.segments.alphas, std::vector<double>(2, contact_alpha(4)));
  EXPECT_TRUE(untraceable_part(field).empty());
}

TEST(Alpha, IsASingleOneWhereTheRuleGivesNoOther) {
  BlendField blend;
  blend.alpha = 0.7;
  EXPECT_EQ(single_angle(blend), 0.7);
  for (const double x : {0.0, 1.0, 2.5}) blend.points.add({{x, 0, 0}, 0.6}, {});
  blend.points.strands = {0, 1, 2};
  blend.direction_bounds = {{0.3, 1.5}, {0.3, 1.5}, {0.3, 1.5}};
  EXPECT_EQ(single_angle(blend), 0.3);
  EXPECT_NEAR(alpha_at(blend, {0.4, 1.2, -0.3}).value, 0.3, 1e-15);
  blend.segments.add({{0, 0, 0}, {1, 0, 0}, 0.2, 0.2}, {});
  blend.segments.strands = {3};
  blend.direction_bounds.push_back({0.3, 1.5});
  EXPECT_FALSE(single_angle(blend));
  EXPECT_TRUE(untraceable_part(blend).empty());
  // A point of the strand of another one, or of a segment, makes no pair with it.
  for (const std::uint32_t strand : {0U, 3U}) {
    blend.points.strands[1] = strand;
    EXPECT_FALSE(untraceable_part(blend).empty()) << strand;
  }
  blend.points.strands[1] = 1;
  blend.direction_bounds[1].most = 1.4;
  EXPECT_TRUE(untraceable_part(blend).empty());
  blend.direction_bounds[1].least = -0.8;
  EXPECT_TRUE(untraceable_part(blend).empty());
  blend.direction_bounds[1].least = -0.81;
  EXPECT_FALSE(untraceable_part(blend).empty());
  blend.segments = {};
  blend.direction_bounds.pop_back();
  EXPECT_FALSE(single_angle(blend));
  blend.direction_bounds.clear();
  blend.alpha_per_skeleton = true;
  blend.points.alphas = {0.9, 0.9, 0.9};
  EXPECT_EQ(single_angle(blend), 0.9);
  EXPECT_NEAR(alpha_at(blend, {0.4, 1.2, -0.3}).value, 0.9, 1e-15);
  blend.points.alphas[2] = 0.8;
  EXPECT_FALSE(single_angle(blend));
  EXPECT_TRUE(untraceable_part(blend).empty());
  blend.points.alphas[2] = -0.8;
  EXPECT_TRUE(untraceable_part(blend).empty());
  blend.points.alphas[2] = -0.81;
  EXPECT_FALSE(untraceable_part(blend).empty());
}

TEST(Alpha, OfContactThatAdaptsToRadiiIsASingleOneWhereTheseAreEqual) {
  BlendField blend;
  blend.segments.add({{0, 0, 0}, {1, 0, 0}, 0.3, 0.3}, {});
  blend.points.add({{0.2, 0.9, 0}, 0.3}, {});
  const auto adapts_to = [&](bool radii, bool density) {
    blend.local_contact =
        std::make_shared<const LocalContact>(kernel_of(blend), true, Projection::Paper, radii, density);
  };
  adapts_to(true, false);
  EXPECT_EQ(single_angle(blend), contact_alpha(4));
  EXPECT_NEAR(alpha_at(blend, {0.4, 0.5, -0.3}).value, contact_alpha(4), 1e-12);
  EXPECT_TRUE(untraceable_part(blend).empty());
  adapts_to(false, true);
  EXPECT_FALSE(single_angle(blend));
  EXPECT_FALSE(untraceable_part(blend).empty());
  adapts_to(true, false);
  blend.points.skeletons[0].radius = 0.31;
  EXPECT_FALSE(single_angle(blend));
  EXPECT_FALSE(untraceable_part(blend).empty());
}

TEST(Alpha, RefusesAnglesOfSkeletonsThatAreOutOfRange) {
  FieldDescription description;
  Primitive primitive;
  primitive.skeleton = PointSkeleton{{0, 0, 0}, 1};
  primitive.alpha = 2;
  description.root = description.add({.what = primitive, .where = {}});
  EXPECT_FALSE(compile(description));
}

}  // namespace
}  // namespace marrow
