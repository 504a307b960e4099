// Laws of the correction operator in the plane of f and G.
#include "field/blend/correction/correction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;
using test::relative;

constexpr double half_pi = std::numbers::pi / 2;

// A place near the reference curve, most often below it, where sums of skeletons lie.
struct Place {
  double f, G;
};
Place random_place(Random& random, int degree) {
  const double f = exp(random.between(-3, 2));
  return {f, ReferenceCurve(degree).at(f) * random.between(0, 1.2)};
}

struct Variant {
  bool cavity;
  Projection projection;
};
constexpr Variant variants[] = {
    {false, Projection::Paper}, {true, Projection::Paper}, {false, Projection::Exact}, {true, Projection::Exact}};

TEST(Correction, PartialsAreTheDerivativesInEveryBranch) {
  Random random(21);
  int in_branch = 0, guarded = 0;
  for (int i = 0; i < 6000; ++i) {
    const auto [cavity, projection] = variants[i % 4];
    const int n = random.whole(3, 8);
    const bool negative = projection == Projection::Paper && i % 8 < 2;
    const double alpha = negative ? random.between(-1, 0) : random.between(0, 1.55);
    const Correction correction(n, alpha, cavity, projection);
    auto [f, G] = random_place(random, n);
    if (negative) f *= random.between(0, 1);
    const double hf = 1e-5 * f, hG = 1e-5 * G;
    const bool branch = correction.in_cavity_branch(f, G);
    if (branch != correction.in_cavity_branch(f - 2 * hf, G) || branch != correction.in_cavity_branch(f + 2 * hf, G) ||
        branch != correction.in_cavity_branch(f, G - 2 * hG) || branch != correction.in_cavity_branch(f, G + 2 * hG))
      continue;
    const auto c = correction.partials(f, G);
    const double df = (correction.value(f + hf, G) - correction.value(f - hf, G)) / (2 * hf);
    const double dG = (correction.value(f, G + hG) - correction.value(f, G - hG)) / (2 * hG);
    if (negative) {
      // leave out the seams of the guard, where the derivative jumps
      const double left = correction.partials(f - 2 * hf, G).df, right = correction.partials(f + 2 * hf, G).df;
      const double low = correction.partials(f, G - 2 * hG).df, high = correction.partials(f, G + 2 * hG).df;
      if (relative(left, right) > 1e-2 || relative(low, high) > 1e-2) continue;
      guarded += c.df == -1;
    }
    EXPECT_EQ(c.value, correction.value(f, G));
    const double scale = std::max(1.0, std::fabs(c.df));
    EXPECT_NEAR(c.df, df, 1e-5 * scale) << "n " << n << " alpha " << alpha << " f " << f << " G " << G;
    EXPECT_NEAR(c.dG * G / f, dG * G / f, 1e-5 * scale) << "n " << n << " alpha " << alpha << " f " << f << " G " << G;
    EXPECT_LE(relative(c.dG_over_G * G, c.dG), 1e-14);
    in_branch += branch;
  }
  EXPECT_GT(in_branch, 500);
  EXPECT_GT(guarded, 10);
}

TEST(Correction, IsContinuousAcrossTheCavityBranch) {
  Random random(22);
  int crossings = 0;
  for (int i = 0; i < 400; ++i) {
    const int n = random.whole(3, 12);
    const double alpha = random.between(0, 1.5), f = exp(random.between(-2, 2));
    const Correction correction(n, alpha, true, i % 2 ? Projection::Paper : Projection::Exact);
    double inside = 0, outside = ReferenceCurve(n).at(f);
    if (!correction.in_cavity_branch(f, inside) || correction.in_cavity_branch(f, outside)) continue;
    for (int step = 0; step < 60; ++step) {
      const double middle = (inside + outside) / 2;
      (correction.in_cavity_branch(f, middle) ? inside : outside) = middle;
    }
    EXPECT_LE(relative(correction.value(f, inside), correction.value(f, outside)), 1e-10);
    ++crossings;
  }
  EXPECT_GT(crossings, 300);
}

TEST(Correction, IsIsotoneInFieldAndGradientAndInAlphaBelowTheCurve) {
  Random random(23);
  for (int i = 0; i < 4000; ++i) {
    const auto [cavity, projection] = variants[i % 4];
    const int n = random.whole(3, 8);
    const double alpha = random.between(0, half_pi);
    auto [f, G] = random_place(random, n);
    const Correction correction(n, alpha, cavity, projection);
    const double here = correction.value(f, G), slack = 1e-9 * here;
    EXPECT_LE(here, correction.value(f * 1.01, G) + slack);
    EXPECT_LE(here, correction.value(f, G * 1.01) + slack);
    if (G > ReferenceCurve(n).at(f)) continue;
    const Correction steeper(n, std::min(half_pi, alpha + 0.01), cavity, projection);
    EXPECT_LE(here, steeper.value(f, G) + slack);
    EXPECT_LE(here, f * (1 + 1e-12));
  }
}

TEST(Correction, LeavesTheReferenceCurveAsItIs) {
  Random random(24);
  for (int n = min_kernel_degree; n <= max_kernel_degree; ++n)
    for (int i = 0; i < 40; ++i) {
      const double f = exp(random.between(-5, 5)), G = ReferenceCurve(n).at(f);
      for (const auto [cavity, projection] : variants)
        EXPECT_LE(relative(Correction(n, random.between(0, half_pi), cavity, projection).value(f, G), f), 1e-13);
    }
}

TEST(Correction, WithHalfPiIsExactlyTheSum) {
  Random random(25);
  for (const auto [cavity, projection] : variants) {
    const Correction sum(4, half_pi, cavity, projection);
    EXPECT_TRUE(sum.is_sum());
    for (int i = 0; i < 20; ++i) {
      const auto [f, G] = random_place(random, 4);
      EXPECT_EQ(sum.value(f, G), f);
      EXPECT_EQ(sum.partials(f, G).df, 1);
      EXPECT_EQ(sum.partials(f, G).dG, 0);
    }
  }
}

TEST(Correction, HoldsAtTheEndsOfItsRange) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const auto [cavity, projection] : variants)
    for (const double alpha : {-1.0, -0.3, 0.0, 0.7, half_pi}) {
      const Correction c(5, alpha, cavity, projection);
      EXPECT_EQ(c.value(0, 0), 0);
      EXPECT_EQ(c.value(0, 1), 0);
      EXPECT_EQ(c.value(inf, 0), inf);
      EXPECT_EQ(c.value(inf, inf), inf);
      for (const double f : {1e-300, 1e-140, 1e-10, 1.0, 1e10, 1e90, 1e300})
        for (const double G : {0.0, 1e-300, 1e-10, 1.0, 1e60}) {
          EXPECT_TRUE(std::isfinite(c.value(f, G))) << f << ' ' << G;
          EXPECT_GE(c.value(f, G), 0) << f << ' ' << G;
          EXPECT_FALSE(std::isnan(c.partials(f, G).df)) << "alpha " << alpha << ' ' << f << ' ' << G;
          EXPECT_TRUE(std::isfinite(c.partials(f, G).dG_over_G * G)) << "alpha " << alpha << ' ' << f << ' ' << G;
        }
    }
}

TEST(Correction, IsSmoothAtCriticalPointsOnlyWithCavity) {
  const auto with = Correction(4, 1.0, true, Projection::Paper).partials(2, 0);
  EXPECT_TRUE(std::isfinite(with.dG_over_G));
  EXPECT_EQ(with.dG, 0);
  EXPECT_TRUE(std::isinf(Correction(4, 1.0, false, Projection::Paper).partials(2, 0).dG));
}

}  // namespace
}  // namespace marrow
