// Laws of blends and programs as functions of space.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "field/blend/blend_field.h"
#include "field/program/field_program.h"
#include "field/skeleton/skeletons.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::for_each_beside;
using test::numeric_gradient;
using test::Random;
using test::random_blend;
using test::relative;

TEST(Blend, GradientIsTheDerivativeOfTheCorrectedFieldInEveryBranch) {
  Random random(31);
  int checked = 0, in_branch = 0;
  double worst = 0;
  for (int i = 0; i < 8000; ++i) {
    const Projection projection = i % 2 ? Projection::Paper : Projection::Exact;
    const double alpha = i % 10 == 1 ? random.between(-0.3, 0) : random.between(0, std::numbers::pi / 2);
    const int n = random.whole(3, 7);
    const Vec3d center = random.vector(2.5), p = center + random.vector(0.1);
    const bool cavity = i % 3 != 0;
    const BlendField blend = i % 4 < 2 ? random_blend(random, n, alpha, cavity, projection)
                                       : mirrored_blend(random, center, n, alpha, cavity, projection);
    const BlendSample s = evaluate(blend, p);
    if (s.corrected < 0.2 || s.corrected > 6) continue;
    if (!cavity && s.si_norm < 0.05 * ReferenceCurve(n).at(s.sum)) continue;  // no derivative at G = 0
    // Only where no seam (branch boundary, end of a distance segment) lies within the differences
    const Correction correction = correction_of(blend);
    const bool branch = correction.in_cavity_branch(s.sum, s.si_norm);
    const double step = 1e-4;
    double jump = 0;
    for_each_beside(p, 3 * step, [&](const Vec3d& q) {
      const BlendSample t = evaluate(blend, q);
      if (correction.in_cavity_branch(t.sum, t.si_norm) != branch) jump = 1;
      jump = std::max(jump, relative(t.corrected_gradient, s.corrected_gradient));
    });
    if (jump > 5e-3) continue;
    const auto value = [&](const Vec3d& q) { return corrected_value(blend, q); };
    const double error = relative(numeric_gradient(value, p, step), s.corrected_gradient);
    EXPECT_LE(error, 1e-6) << "n " << blend.degree << " alpha " << alpha << " branch " << branch;
    worst = std::max(worst, error);
    ++checked;
    in_branch += branch;
  }
  std::cout << "  " << checked << " places, " << in_branch << " in the cavity branch, worst " << worst << '\n';
  EXPECT_GT(checked, 800);
  EXPECT_GT(in_branch, 100);
}

TEST(Blend, GradientVanishesSmoothlyBetweenTwoEqualBalls) {
  BlendField blend;
  blend.alpha = 1.0;
  blend.points.add({{-1, 0, 0}, 1}, {});
  blend.points.add({{1, 0, 0}, 1}, {});
  EXPECT_LE(length(evaluate(blend, {0, 0, 0}).corrected_gradient), 1e-15);
  EXPECT_LE(length(evaluate(blend, {1e-9, 0, 0}).corrected_gradient), 1e-7);
}

TEST(Blend, ValueAloneIsTheValueOfTheSampleBitForBit) {
  Random random(32);
  for (int i = 0; i < 500; ++i) {
    const BlendField blend = random_blend(random, random.whole(3, 20), random.between(-1, 1.57), i % 2 == 0,
                                          i % 3 == 0 ? Projection::Exact : Projection::Paper);
    const Vec3d p = random.vector(2);
    EXPECT_EQ(corrected_value(blend, p), evaluate(blend, p).corrected);
  }
}

TEST(Blend, CorrectedFieldIsMonotoneInAlphaBelowTheReferenceCurve) {
  Random random(33);
  for (int i = 0; i < 300; ++i) {
    BlendField blend;
    blend.degree = random.whole(3, 8);
    for (int k = 0; k < 5; ++k) blend.points.add(random.point(), {});
    const Vec3d p = random.vector(1.6);
    double last = 0;
    for (const double alpha : {0.0, 0.3, 0.9, 1.2, 1.5, std::numbers::pi / 2}) {
      blend.alpha = alpha;
      const double v = corrected_value(blend, p);
      EXPECT_LE(last, v * (1 + 1e-9));  // sums of points lie below the curve
      last = v;
    }
  }
}

TEST(Blend, IsInfiniteWithoutDerivativesOnASkeleton) {
  Random random(34);
  BlendField blend = random_blend(random, 4, 1, true, Projection::Paper);
  const BlendSample s = evaluate(blend, blend.points.skeletons[0].at);
  EXPECT_TRUE(std::isinf(s.sum) && std::isinf(s.corrected));
  EXPECT_EQ(s.corrected_gradient, Vec3d{});
}

TEST(Blend, StrongestMaterialIsThatOfTheLargestShare) {
  BlendField blend;
  blend.points.add({{-1, 0, 0}, 1}, {});
  blend.points.add({{1, 0, 0}, 1}, MaterialId{7});
  EXPECT_FALSE(strongest_material(blend, {-0.5, 0, 0}).valid());
  EXPECT_EQ(strongest_material(blend, {0.5, 0, 0}), MaterialId{7});
}

// w_i = f_i / f, and a strand that is cut into many pieces weighs what it does as one.
TEST(Blend, MaterialWeightsDoNotDependOnHowASkeletonIsCut) {
  Random random(37);
  for (int round = 0; round < 50; ++round) {
    const SegmentSkeleton whole{{-1, 1, 0}, {1, 1, 0}, 0.5, 0.5}, other{{-1, -1, 0}, {1, -1, 0}, 0.5, 0.5};
    const Vec3d p = random.vector(1.5);
    const int pieces = random.whole(2, 9);
    BlendField blend;
    for (int i = 0; i < pieces; ++i) {
      const double from = -1 + 2.0 * i / pieces, to = -1 + 2.0 * (i + 1) / pieces;
      blend.segments.add({{from, 1, 0}, {to, 1, 0}, 0.5, 0.5}, MaterialId{3});
    }
    blend.segments.add(other, MaterialId{5});
    const MaterialWeights weights = material_weights(blend, p);
    const double f = segment_field<Derivatives::ScaleInvariant>(whole, p, blend.degree).value,
                 g = segment_field<Derivatives::ScaleInvariant>(other, p, blend.degree).value;
    ASSERT_EQ(weights.size(), 2u);
    EXPECT_NEAR(weights[0].weight, f / (f + g), 1e-12);
    EXPECT_NEAR(weights[1].weight, g / (f + g), 1e-12);
    EXPECT_EQ(strongest_material(blend, p), f > g ? MaterialId{3} : MaterialId{5});
  }
  const BlendField touched = [] {
    BlendField blend;
    blend.points.add({{0, 0, 0}, 1}, MaterialId{3});
    blend.points.add({{1, 0, 0}, 1}, MaterialId{5});
    return blend;
  }();
  ASSERT_EQ(material_weights(touched, {1, 0, 0}).size(), 1u);
  EXPECT_EQ(material_weights(touched, {1, 0, 0})[0].material, MaterialId{5});
}

TEST(Blend, BoundsHoldEverySkeleton) {
  Random random(35);
  const BlendField blend = random_blend(random, 4, 1, true, Projection::Paper);
  const Box3 box = skeleton_bounds(blend);
  for (const auto& s : blend.segments.skeletons) EXPECT_TRUE(box.contains(s.from) && box.contains(s.to));
  for (const auto& s : blend.points.skeletons) EXPECT_TRUE(box.contains(s.at));
  EXPECT_TRUE(skeleton_bounds(BlendField{}).empty());
}

TEST(Program, ValueIsTheLargestOfItsParts) {
  Random random(36);
  for (int i = 0; i < 200; ++i) {
    std::vector<PlacedBlend> parts(3);
    for (PlacedBlend& part : parts) part.blend = random_blend(random, 4, 1.2, true, Projection::Paper);
    const Vec3d p = random.vector(2);
    double largest = 0;
    for (const PlacedBlend& part : parts) largest = std::max(largest, corrected_value(part.blend, p));
    const FieldProgram program(parts);
    EXPECT_EQ(value(program, p), largest);
    EXPECT_EQ(evaluate(program, p).value, largest);
    EXPECT_FALSE(is_single_blend(program));
  }
}

TEST(Program, OfNothingIsOutsideEverywhere) {
  EXPECT_EQ(evaluate(FieldProgram{}, {1, 2, 3}).value, 0);
  EXPECT_EQ(value(FieldProgram{}, {1, 2, 3}), 0);
}

}  // namespace
}  // namespace marrow
