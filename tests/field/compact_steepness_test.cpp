// The largest derivatives of the compact kernel against those at many places.
#include "field/blend/bounds/sum/compact_steepness.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

struct Largest {
  double first = 0, second = 0, third = 0;
};

// Of k(x) = K(x^2): 2x K'; 2 K' and 2 K' + 4 x^2 K''; along a line at the angle of cosine c 12 c x K'' + 8 c^3 x^3
// K'''.
Largest by_sampling(const Profile& profile, double R, double most) {
  constexpr int places = 400, angles = 20;
  Largest largest;
  for (int i = 0; i < places; ++i) {
    const double w = most * (i + 1) / places, y = R * R * (1 - w), x = std::sqrt(y);
    const auto [value, slope, curvature] = profile.at(y);
    largest.first = std::max(largest.first, std::fabs(2 * x * slope));
    largest.second = std::max({largest.second, std::fabs(2 * slope), std::fabs(2 * slope + 4 * y * curvature)});
    for (int j = 0; j <= angles; ++j) {
      const double c = static_cast<double>(j) / angles, cx = c * x;
      largest.third = std::max(largest.third, std::fabs(12 * cx * curvature + 8 * cx * cx * cx * profile.third(y)));
    }
  }
  const double scale = 1 / profile.normalisation();
  return {largest.first * scale, largest.second * scale, largest.third * scale};
}

TEST(CompactSteepness, IsTheLargestThereIs) {
  Random random(20261127);
  for (int i = 0; i < 2000; ++i) {
    const int n = random.whole(3, 20), dimension = i % 3;
    const double R = random.between(1.05, 4), most = i % 5 == 0 ? 1 : random.between(0.01, 1);
    const Profile profile({KernelFamily::Compact, n, R}, dimension);
    const CompactSteepness steepness(profile, R, most);
    const Largest found = by_sampling(profile, R, most);
    EXPECT_LE(found.first, steepness.first());
    EXPECT_LE(steepness.first(), found.first * 1.02);
    if (profile.degree() >= 4) {
      EXPECT_LE(found.second, steepness.second());
      EXPECT_LE(steepness.second(), found.second * 1.02);
    }
    if (profile.degree() >= 6) {
      EXPECT_LE(found.third, steepness.third()) << profile.degree() << ' ' << most;
      EXPECT_LE(steepness.third(), found.third * 1.03) << profile.degree() << ' ' << most;
    }
  }
}

}  // namespace
}  // namespace marrow
