// Bounds of the operator and of its partial derivatives for angles below 0 hold them: where C is guarded, behind the
// critical point, and between; and they come near them where intervals are short.
#include "field/blend/bounds/correction/partials_below_zero.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "field/math/box3.h"
#include "tests/field/partials_check.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::expect_holds;
using test::expect_holds_difference;
using test::Random;
using test::text;
using test::within;

// One setting of the operator and ranges of what it is applied to.
struct Setting {
  int degree;
  bool cavity;
  Interval alpha, f, G;

  Correction at(double angle) const { return {degree, angle, cavity, Projection::Paper}; }
  Interval value() const { return hull(correction_bounds(at(alpha.lo), f, G), correction_bounds(at(alpha.hi), f, G)); }
  PartialBounds partials() const { return partials_below_zero(at(alpha.lo), alpha, value(), f, G); }
};

// From far beyond the surface, where the guard acts, to deep inside; G also 0, and beside the curve. Half of them with
// a range of angles.
Setting random_setting(Random& random, double width) {
  const int n = random.whole(3, 10);
  const double f = std::exp(random.between(-9, 3));
  const double on_curve = ReferenceCurve(n).at(f) * std::fabs(1 + width * random.between(-2, 1));
  const double G = random.between(0, 1) < 0.3 ? on_curve : on_curve * std::pow(random.between(0, 1.3), 2);
  const double alpha = random.between(-1, -1e-3), other = std::min(0.0, alpha + width * random.between(0, 1));
  return {.degree = n,
          .cavity = random.between(0, 1) < 0.7,
          .alpha = {alpha, random.between(0, 1) < 0.5 ? alpha : other},
          .f = {f, f * (1 + width * random.between(0, 1))},
          .G = {random.between(0, 1) < 0.1 ? 0 : G, G * (1 + width * random.between(0, 1))}};
}

double width_of_either(Random& random) { return std::pow(10.0, random.between(-7, 0.5)); }

std::string text(const Setting& s) {
  return "degree " + std::to_string(s.degree) + (s.cavity ? " cavity" : "") + " alpha " + text(s.alpha) + " f " +
         text(s.f) + " G " + text(s.G);
}

TEST(BelowZero, BoundsHoldEveryValue) {
  Random random(20261127);
  int behind = 0;
  for (int i = 0; i < 200'000 && !HasFailure(); ++i) {
    const Setting s = random_setting(random, width_of_either(random));
    const Interval bounds = s.value();
    for (int k = 0; k < 4; ++k) {
      const Correction c = s.at(within(random, s.alpha, k));
      const double f = within(random, s.f, k), G = within(random, s.G, (i + k) % 4), C = c.value(f, G);
      behind += c.in_cavity_branch(f, G);
      EXPECT_TRUE(bounds.contains(C)) << text(s) << ": " << C << " is not in " << bounds.lo << " .. " << bounds.hi;
    }
  }
  EXPECT_GT(behind, 100'000);
}

// What the bounds of a box that holds a skeleton rest on.
TEST(BelowZero, WithCavityNoFieldOrGradientBeyondGivesLess) {
  Random random(20261131);
  for (int i = 0; i < 200'000 && !HasFailure(); ++i) {
    const Correction c(random.whole(3, 12), random.between(-1, 0), true, Projection::Paper);
    const double least = std::exp(random.between(-6, 4)), at_least = c.value(least, 0);
    const double f = least * std::exp(random.between(0, 1) < 0.5 ? 0 : random.between(0, 12));
    const double G = ReferenceCurve(c.degree()).at(f) * std::exp(random.between(-12, 3));
    EXPECT_GE(c.value(f, G), at_least * (1 - 1e-12))
        << "degree " << c.degree() << " alpha " << c.alpha() << " f " << least << " .. " << f << " G " << G;
  }
}

TEST(BelowZero, BoundsHoldThePartialsOfEveryPlace) {
  Random random(20261128);
  int known = 0;
  for (int i = 0; i < 200'000 && !HasFailure(); ++i) {
    const Setting s = random_setting(random, width_of_either(random));
    SCOPED_TRACE(text(s));
    const PartialBounds bounds = s.partials();
    known += bounds.df.hi < Box3::inf;
    for (int k = 0; k < 4; ++k) {
      const double f = within(random, s.f, k), G = within(random, s.G, (i + k) % 4);
      expect_holds(bounds, s.at(within(random, s.alpha, k)).partials(f, G));
    }
  }
  EXPECT_GT(known, 100'000);
}

// Over jumps of the derivatives, too.
TEST(BelowZero, BoundsHoldDifferencesOfValues) {
  Random random(20261129);
  for (int i = 0; i < 200'000 && !HasFailure(); ++i) {
    const Setting s = random_setting(random, std::pow(10.0, random.between(-3, 0.5)));
    SCOPED_TRACE(text(s));
    const PartialBounds bounds = s.partials();
    const auto place = [&] {
      const double f = within(random, s.f, 2), G = within(random, s.G, 2), alpha = within(random, s.alpha, 2);
      return test::AppliedTo{f, G, alpha, s.at(alpha).value(f, G)};
    };
    expect_holds_difference(bounds, place(), place());
  }
}

// No wider than short intervals make them, but where derivatives jump.
TEST(BelowZero, BoundsOfShortIntervalsAreShort) {
  Random random(20261130);
  constexpr double width = 1e-6;
  int known = 0, narrow = 0, all = 0;
  double widest = 0;
  for (int i = 0; i < 50'000; ++i) {
    Setting s = random_setting(random, width);
    if (s.G.lo == 0) s.G.hi *= width;
    s.alpha.hi = s.alpha.lo;  // behind the critical point nothing is known of ranges
    const Interval value = s.value();
    widest = std::max(widest, value.width() / (s.f.hi + s.G.hi));
    if (value.lo == 0 || (s.G.lo == 0 && !s.cavity)) continue;  // is cut; dC/dG is infinite
    ++all;
    const PartialBounds bounds = s.partials();
    known += bounds.df.hi < Box3::inf && bounds.dG.hi < Box3::inf;
    narrow += bounds.df.width() < 0.01 * (1 + abs(bounds.df).hi) && bounds.dG.width() < 0.01 * (1 + abs(bounds.dG).hi);
  }
  std::cout << "  of " << all << " settings known " << known << ", narrow " << narrow << ", widest value " << widest
            << '\n';
  EXPECT_GT(all, 20'000);
  EXPECT_GT(known, 0.999 * all);
  EXPECT_GT(narrow, 0.99 * all);
  EXPECT_LT(widest, 1e-3);
}

}  // namespace
}  // namespace marrow
