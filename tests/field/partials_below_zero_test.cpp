// Bounds of the operator and of its partial derivatives for angles below 0 hold them: where C is guarded, behind the
// critical point, and between; and they come near them where intervals are short.
#include "field/blend/partials_below_zero.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "field/math/box3.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

struct Setting {
  Correction correction;
  Interval f, G;
  Interval value() const { return correction_bounds(correction, f, G); }
  PartialBounds partials() const { return partials_below_zero(correction, correction.alpha(), value(), f, G); }
};

// From far beyond the surface, where the guard acts, to deep inside; G also 0, and beside the curve.
Setting random_setting(Random& random, double width) {
  const int n = random.whole(3, 10);
  const double f = std::exp(random.between(-9, 3));
  const double on_curve = ReferenceCurve(n).at(f) * std::fabs(1 + width * random.between(-2, 1));
  const double G = random.between(0, 1) < 0.3 ? on_curve : on_curve * std::pow(random.between(0, 1.3), 2);
  const double end = f * (1 + width * random.between(0, 1)), G_end = G * (1 + width * random.between(0, 1));
  return {Correction(n, random.between(-1, -1e-3), random.between(0, 1) < 0.7, Projection::Paper),
          {f, end},
          {random.between(0, 1) < 0.1 ? 0 : G, G_end}};
}

double width_of_either(Random& random) { return std::pow(10.0, random.between(-7, 0.5)); }

double within(Random& random, const Interval& x, int k) {
  return k == 0 ? x.lo : k == 1 ? x.hi : std::clamp(random.between(x.lo, x.hi), x.lo, x.hi);
}

std::string text(const Setting& s) {
  const auto range = [](const Interval& x) { return std::to_string(x.lo) + " .. " + std::to_string(x.hi); };
  return "degree " + std::to_string(s.correction.degree()) + (s.correction.cavity() ? " cavity" : "") + " alpha " +
         std::to_string(s.correction.alpha()) + " f " + range(s.f) + " G " + range(s.G);
}

void expect_holds(const Interval& bounds, double x, const char* name) {
  const double slack = 1e-8 * std::fabs(x) + 1e-9;
  EXPECT_TRUE(bounds.lo - slack <= x && x <= bounds.hi + slack)
      << name << " " << x << " is not in " << bounds.lo << " .. " << bounds.hi;
}

TEST(BelowZero, BoundsHoldEveryValue) {
  Random random(20261127);
  int behind = 0;
  for (int i = 0; i < 200'000 && !HasFailure(); ++i) {
    const Setting s = random_setting(random, width_of_either(random));
    const Interval bounds = s.value();
    for (int k = 0; k < 4; ++k) {
      const double f = within(random, s.f, k), G = within(random, s.G, (i + k) % 4), C = s.correction.value(f, G);
      behind += s.correction.in_cavity_branch(f, G);
      EXPECT_TRUE(bounds.contains(C)) << text(s) << ": " << C << " is not in " << bounds.lo << " .. " << bounds.hi;
    }
  }
  EXPECT_GT(behind, 100'000);
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
      const CorrectionPartials p = s.correction.partials(f, G);
      expect_holds(bounds.df, p.df, "df");
      expect_holds(bounds.dG, p.dG, "dG");
    }
  }
  EXPECT_GT(known, 100'000);
}

// The mean value theorem, over jumps of the derivatives too: what slopes of rays are used for.
TEST(BelowZero, BoundsHoldDifferencesOfValues) {
  Random random(20261129);
  for (int i = 0; i < 200'000 && !HasFailure(); ++i) {
    const Setting s = random_setting(random, std::pow(10.0, random.between(-3, 0.5)));
    SCOPED_TRACE(text(s));
    const PartialBounds bounds = s.partials();
    const auto pair = [&](const Interval& x) { return std::pair{within(random, x, 2), within(random, x, 3)}; };
    const auto [f, other_f] = pair(s.f);
    const auto [G, other_G] = pair(s.G);
    const double C = s.correction.value(f, G);
    const auto expect_slope = [&](const Interval& of, double step, double rise, const char* name) {
      if (std::fabs(step) < 1e-5 * (f + G)) return;
      expect_holds({of.lo - 1e-9, of.hi + 1e-9}, rise / step, name);
    };
    expect_slope(bounds.df, other_f - f, s.correction.value(other_f, G) - C, "along f");
    expect_slope(bounds.dG, other_G - G, s.correction.value(f, other_G) - C, "along G");
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
    const Interval value = s.value();
    widest = std::max(widest, value.width() / (s.f.hi + s.G.hi));
    if (value.lo == 0 || (s.G.lo == 0 && !s.correction.cavity())) continue;  // is cut; dC/dG is infinite
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
