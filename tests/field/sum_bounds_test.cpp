// Bounds of sums and of their derivatives, each by itself, against exact sums at places of boxes and of stretches.
#include "field/blend/bounds/sum/sum_bounds.h"

#include <algorithm>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

// How often something was bounded, by less than twice what it was in the middle.
struct Told {
  int gradients = 0, Js = 0;
};

void expect_in(const Interval& x, double found, double slack, const char* what) {
  EXPECT_TRUE(x.lo - slack <= found && found <= x.hi + slack)
      << what << ": " << found << " not in [" << x.lo << ", " << x.hi << "]";
}

void check_place(const SumBounds& sum, const SkeletonSample& at, const SkeletonSample& middle, double error,
                 Told& told) {
  const double slope_error = error * (1 + length(at.gradient)), bent = length(middle.si_jacobian.rows[0]);
  expect_in(sum.f(), at.value, error * at.value, "f");
  if (sum.unbounded()) return;
  EXPECT_LE(length(at.si_gradient), sum.longest_S() + slope_error);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_in(sum.S()[i], at.si_gradient[i], slope_error, "S");
    if (!sum.has_slopes()) continue;
    const Interval gradient = sum.gradient()[i];
    expect_in(gradient, at.gradient[i], slope_error, "gradient");
    told.gradients += gradient.width() < 2 * length(middle.gradient);
    for (std::size_t j = 0; j < 3; ++j) {
      expect_in(sum.J(i, j), at.si_jacobian.rows[i][j], error * (1 + bent), "J");
      told.Js += sum.J(i, j).width() < 2 * bent;
    }
  }
}

// A vector no longer than that.
Vec3d within(Random& random, double length) { return normalize(random.vector(1)) * (length * random.between(0, 1)); }

// Along the stretch from -1 to 1, which is straight or not quite.
void check_stretch(const BlendField& blend, const Vec3d& center, const Vec3d& half, double error, Random& random) {
  const double bent = random.between(0, 1) < 0.5 ? 0 : random.between(0, 0.5);
  const Stretch way{half, normalize(half), bent * length(half), bent};
  const Box3 box = Box3{center, center}.padded(max_component(abs(half)) + way.slack);
  const SumBounds sum(blend, box, Wanted::Slopes, &way);
  for (int k = 0; k < 4; ++k) {
    const Vec3d p = center + half * random.between(-1, 1) + within(random, way.slack);
    const Vec3d along = way.direction + within(random, way.turn);
    const auto at = sum_of_primitives<Derivatives::Second>(blend, p);
    expect_in(sum.f(), at.value, error * at.value, "f of a stretch");
    if (!sum.has_slopes()) continue;
    EXPECT_LE(length(at.si_gradient), sum.longest_S() + error);
    expect_in(sum.f_along(), dot(at.gradient, along), error * (1 + length(at.gradient)), "its slope");
    for (std::size_t i = 0; i < 3; ++i)
      expect_in(sum.S_along(i), dot(at.si_jacobian.rows[i], along), error * (1 + length(at.si_jacobian.rows[i])),
                "slope of S");
  }
}

// In a box that is turned and sheared, and a little beyond.
void check_skew_box(const BlendField& blend, const Vec3d& center, double half, const SkeletonSample& middle,
                    double error, Random& random, Told& told) {
  const SkewBox skew{{random.vector(half), random.vector(half), random.vector(half)}, random.between(0, 0.2) * half};
  const Box3 box = Box3{center, center}.padded(3.2 * half);
  const SumBounds sum(blend, box, Wanted::Slopes, &skew);
  EXPECT_LT(sum.rho(), 0.5 * length(box.size()));
  for (int k = 0; k < 4; ++k) {
    Vec3d p = center + within(random, skew.slack);
    for (const Vec3d& way : skew.halves) p += way * random.between(-1, 1);
    check_place(sum, sum_of_primitives<Derivatives::Second>(blend, p), middle, error, told);
  }
}

Told check_sums(const std::function<BlendField(Random&)>& draw, unsigned seed, int cases, double error) {
  SCOPED_TRACE(seed);
  Random random(seed);
  Told told;
  for (int i = 0; i < cases && !testing::Test::HasFailure(); ++i) {
    const BlendField blend = draw(random);
    const Vec3d center = random.vector(1.5);
    const double half = pow(10, random.between(-5, -0.3));
    const SumBounds sum(blend, Box3{center, center}.padded(half));
    const auto middle = sum_of_primitives<Derivatives::Second>(blend, center);
    for (int k = 0; k < 8; ++k)
      check_place(sum, sum_of_primitives<Derivatives::Second>(blend, center + random.vector(half)), middle, error,
                  told);
    check_stretch(blend, center, random.vector(half), error, random);
    check_skew_box(blend, center, half, middle, error, random, told);
    EXPECT_FALSE(testing::Test::HasFailure()) << "case " << i << ", half size " << half << ", degree " << blend.degree;
  }
  return told;
}

BlendField compact_blend(Random& random, int most_degree = 9) {
  BlendField blend;
  blend.degree = random.whole(3, most_degree);
  blend.kernel = KernelFamily::Compact;
  blend.kernel_shape = random.between(1.2, 3);
  return blend;
}

// A radius and one that is up to five times as large.
double wider(Random& random, double radius) { return radius * random.between(1, 5); }

TEST(SumBounds, HoldForPointsAndSegmentsOfEndlessKernels) {
  const auto draw = [](Random& random) {
    BlendField blend;
    blend.degree = random.whole(3, 9);
    blend.kernel = random.between(0, 1) < 0.5 ? KernelFamily::Inverse : KernelFamily::Cauchy;
    blend.kernel_shape = random.between(0.5, 3);
    for (int i = 0; i < 3; ++i) blend.points.add(random.point(), {});
    for (int i = 0; i < 2; ++i) blend.segments.add(random.segment(), {});
    return blend;
  };
  const Told told = check_sums(draw, 60, 1500, 1e-8);
  EXPECT_GT(told.gradients, 8000);
  EXPECT_GT(told.Js, 15000);
}

TEST(SumBounds, HoldForTaperedSegmentsOfCompactSupport) {
  const auto draw = [](Random& random) {
    BlendField blend = compact_blend(random);
    SegmentSkeleton s = random.segment();
    s.radius_to = wider(random, s.radius_from);
    blend.segments.add(s, {});
    return blend;
  };
  const Told told = check_sums(draw, 61, 6000, 1e-8);
  EXPECT_GT(told.gradients, 8000);
  EXPECT_GT(told.Js, 15000);
}

TEST(SumBounds, HoldForTaperedArcsOfCompactSupport) {
  const auto draw = [](Random& random) {
    BlendField blend = compact_blend(random);
    ArcSkeleton s = random.arc();
    s.radius_to = wider(random, s.radius_from);
    blend.arcs.add(s, {});
    return blend;
  };
  const Told told = check_sums(draw, 62, 1000, 1e-8);
  EXPECT_GT(told.gradients, 5000);
  EXPECT_GT(told.Js, 10000);
}

TEST(SumBounds, HoldForTaperedTrianglesOfCompactSupport) {
  const auto draw = [](Random& random) {
    BlendField blend = compact_blend(random);
    TriangleSkeleton s = random.triangle();
    for (const std::size_t k : {1u, 2u}) s.radii[k] = wider(random, s.radii[0]);
    blend.triangles.add(s, {});
    return blend;
  };
  const Told told = check_sums(draw, 63, 400, 1e-8);
  EXPECT_GT(told.gradients, 2000);
  EXPECT_GT(told.Js, 3000);
}

// Its second derivatives grow without bound towards the edge of the support, or have a jump there.
TEST(SumBounds, HoldForTheCompactKernelsOfTheLowestDegrees) {
  const auto draw = [](Random& random) {
    BlendField blend = compact_blend(random, 4);
    const auto other = [&](double radius) { return random.between(0, 1) < 0.5 ? radius : wider(random, radius); };
    const int kind = random.whole(0, 2);
    if (kind == 0) {
      ArcSkeleton s = random.arc();
      s.radius_to = other(s.radius_from);
      blend.arcs.add(s, {});
    } else if (kind == 1) {
      SegmentSkeleton s = random.segment();
      s.radius_to = other(s.radius_from);
      blend.segments.add(s, {});
    } else {
      TriangleSkeleton s = random.triangle();
      for (const std::size_t k : {1u, 2u}) s.radii[k] = other(s.radii[0]);
      blend.triangles.add(s, {});
    }
    return blend;
  };
  const Told told = check_sums(draw, 64, 1500, 1e-8);
  EXPECT_GT(told.gradients, 5000);
}

// Whose radius grows nearly as fast as the support, from places around the tip and behind it, where only its mirror
// image would be.
TEST(SumBounds, HoldForSteepConesOfTheLowestDegree) {
  const auto draw = [](Random& random) {
    BlendField blend = compact_blend(random, 3);
    const double slope = (1 - pow(10, random.between(-4.5, -2))) / blend.kernel_shape, begin = random.between(10, 60),
                 end = begin + random.between(5, 20);
    blend.segments.add({{begin, 0, 0}, {end, 0, 0}, begin * slope, end * slope}, {});
    return blend;
  };
  check_sums(draw, 66, 6000, 1e-8);
}
// From behind the tip, where only the mirror image of the cone has roots, to where the cone itself comes in.
TEST(SumBounds, HoldAcrossThePlaneOfATip) {
  BlendField blend;
  blend.degree = 3;
  blend.kernel = KernelFamily::Compact;
  blend.kernel_shape = 2;
  constexpr double slope = 0.99959907 / 2;
  blend.segments.add({{1000, 0, 0}, {1200, 0, 0}, 1000 * slope, 1200 * slope}, {});
  for (const double height : {10.0, 20.0, 30.59265, 35.0}) {
    const Vec3d center{-1, height, 0}, half{1.868, 0, 0};
    const Stretch way{half, normalize(half), 0, 0};
    const SumBounds sum(blend, Box3{center, center}.padded(half.x), Wanted::Slopes, &way);
    for (int k = -20; k <= 20; ++k) {
      const auto at = sum_of_primitives<Derivatives::Second>(blend, center + half * (k / 20.0));
      for (std::size_t i = 0; i < 3; ++i) expect_in(sum.S_along(i), at.si_jacobian.rows[i].x, 1e-8, "slope of S");
    }
  }
}
// Near the edge of their support, where angles from the place are small.
TEST(SumBounds, HoldBesideCirclesOfManyRadii) {
  Random random(68);
  Told told;
  for (int i = 0; i < 400; ++i) {
    SCOPED_TRACE(i);
    BlendField blend = compact_blend(random, 3);
    const double major = pow(10, random.between(1, 6)), depth = pow(10, random.between(-6, -0.5));
    ArcSkeleton s{.center = {}, .major = major, .radius_from = 0.05, .radius_to = 0.05};
    blend.arcs.add(s, {});
    const double reach = blend.kernel_shape * s.radius_from, half = reach * depth * random.between(0.05, 1);
    const auto [sine, cosine] = sincos(random.between(-3, 3));
    const Vec3d center = Vec3d{cosine, sine, 0} * (major + reach * (1 - depth));
    const SumBounds sum(blend, Box3{center, center}.padded(half));
    const auto middle = sum_of_primitives<Derivatives::Second>(blend, center);
    for (int k = 0; k < 8; ++k)
      check_place(sum, sum_of_primitives<Derivatives::Second>(blend, center + random.vector(half)), middle, 1e-6, told);
  }
}
// A bound of how far their Jacobians change, where no other degree helps.
TEST(SumBounds, TellJacobiansOfSegmentsOfTheLowestDegree) {
  const auto draw = [](Random& random) {
    BlendField blend = compact_blend(random, 3);
    blend.segments.add(random.segment(), {});
    return blend;
  };
  const Told told = check_sums(draw, 67, 1500, 1e-8);
  EXPECT_GT(told.Js, 20000);
}

// Parts of an arc may have bounds of their second derivatives where all of it has none, because its radius grows.
TEST(SumBounds, TellNothingOfAnArcThatItsPartsDoNot) {
  const auto draw = [](Random& random) {
    BlendField blend = compact_blend(random, 3);
    ArcSkeleton s{.center = {}, .major = 2, .begin = 0, .end = 3.4, .radius_from = 0.4};
    s.radius_to = random.between(1.5, 3);
    blend.arcs.add(s, {});
    return blend;
  };
  check_sums(draw, 65, 800, 1e-8);
}

}  // namespace
}  // namespace marrow
