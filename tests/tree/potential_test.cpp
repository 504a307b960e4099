// Potentials: where their surfaces are, and how they begin and end.
#include "field/tree/potential.h"

#include <cmath>
#include <variant>

#include <gtest/gtest.h>

#include "tests/number/precise.h"
#include "tests/tree/random_node.h"

namespace marrow::test {
namespace {

std::vector<Potential> all_potentials(double range) {
  std::vector<Potential> all{WyvillProfile{range}, SoftObjectProfile{range}, MetaballProfile{range}};
  for (int k = PolynomialProfile::least; k <= PolynomialProfile::most; ++k) all.push_back(PolynomialProfile{range, k});
  return all;
}
double field_at(const Potential& potential, double distance) { return bounded_field(potential, distance); }

TEST(Potential, IsOneOnTheSurface) {
  for (const Potential& potential : all_potentials(0.7)) {
    EXPECT_NEAR(field_at(potential, 0), 1, 1e-15);
    const Precise exact =
        std::visit([](const auto& profile) { return profile.profile(Precise(profile.surface())); }, potential);
    // The slope of no profile is above 4 there, and its constant is right to half an ulp.
    EXPECT_LT(std::fabs(exact.v - 1), 4 * 0x1p-53L);
  }
}

TEST(Potential, FallsFromTwoInsideToNothingAtItsRange) {
  for (const double range : {1e-3, 0.7, 40.0}) {
    for (const Potential& potential : all_potentials(range)) {
      EXPECT_EQ(field_at(potential, range * (1 + 1e-15)), 0);
      EXPECT_GT(field_at(potential, range * 0.99), 0);
      EXPECT_EQ(field_at(potential, -2 * range), 2);
      double before = 2;
      for (int i = 0; i <= 1000; ++i) {
        const double f = field_at(potential, range * (-1.5 + 0.003 * i));
        EXPECT_LE(f, before);
        before = f;
      }
      EXPECT_NEAR(range_of(potential), range, 0);
    }
  }
}

TEST(Potential, BeginsAndEndsFlat) {
  for (const Potential& potential : all_potentials(1)) {
    const double surface = std::visit([](const auto& profile) { return profile.surface(); }, potential);
    const double deepest = -surface / (1 - surface);
    for (const double end : {deepest, 1.0}) {
      const double inward = end < 0 ? 1e-6 : -1e-6;
      const auto field = bounded_field(potential, Jet<double, 1>::variable(end + inward, 0));
      EXPECT_NEAR(field.slope[0], 0, 1e-4);  // a second derivative of at most 36
    }
    // Slopes are continuous: no step of 1e-4 changes one by more than the second derivative allows.
    double before = 0;
    for (double d = deepest - 0.01; d < 1.01; d += 1e-4) {
      const double slope = bounded_field(potential, Jet<double, 1>::variable(d, 0)).slope[0];
      EXPECT_NEAR(slope, before, 40e-4) << d;
      before = slope;
    }
  }
}

// As the papers have them, with their surface at 1/2.
TEST(Potential, IsTwiceThatOfThePapers) {
  for (double x = 0; x < 1; x += 0.01) {
    const double u = x * x;
    EXPECT_NEAR(WyvillProfile::profile(x), 2 * std::pow(1 - u, 3), 1e-15);
    EXPECT_NEAR((PolynomialProfile{1, 5}.profile(x)), 2 * std::pow(1 - u, 5), 2e-15);
    EXPECT_NEAR(SoftObjectProfile::profile(x), 2 * (1 - 22 * u / 9 + 17 * u * u / 9 - 4 * u * u * u / 9), 2e-15);
    EXPECT_NEAR(MetaballProfile::profile(x), x < 1.0 / 3 ? 2 - 6 * u : 3 * (1 - x) * (1 - x), 1e-15);
  }
  EXPECT_EQ(SoftObjectProfile::profile(0.5), 1);
}

TEST(Potential, RangesOfValuesAreNarrow) {
  Random random(31);
  for (const Potential& potential : all_potentials(1)) {
    for (int i = 0; i < 300; ++i) {
      const double from = random.between(-1, 1), to = from + random.between(0, 1);
      const Interval field = bounded_field(potential, Interval(from, to));
      EXPECT_NEAR(field.lo, field_at(potential, to), 1e-13);
      EXPECT_NEAR(field.hi, field_at(potential, from), 1e-13);
      EXPECT_GE(field.lo, 0);
    }
  }
}

}  // namespace
}  // namespace marrow::test
