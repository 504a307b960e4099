// Laws of round numbers.
#include "renderer/slice/ticks.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace marrow {
namespace {

TEST(Ticks, LieInsideAreEvenAndFew) {
  constexpr unsigned seed = 3;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> where(-1, 1), decades(-12, 12);
  for (int i = 0; i < 20000; ++i) {
    const double size = std::pow(10, decades(random)), low = where(random) * size * 5, high = low + size;
    const int most = 2 + i % 10;
    const auto found = ticks(low, high, most);
    ASSERT_LE(found.size(), static_cast<std::size_t>(most)) << low << " " << high;
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_GE(found[k], low - 1e-6 * size);
      ASSERT_LE(found[k], high + 1e-6 * size);
      if (k > 1) { ASSERT_NEAR(found[k] - found[k - 1], found[1] - found[0], 1e-9 * size); }
    }
    if (most > 4) { ASSERT_GE(found.size(), 2u) << low << " " << high; }
  }
}

TEST(Ticks, CountTheEnds) {
  EXPECT_EQ(ticks(0, 2, 5), (std::vector<double>{0, 0.5, 1, 1.5, 2}));
  EXPECT_EQ(ticks(-0.3, 0.3, 7).size(), 7u);
  EXPECT_EQ(ticks(1, 1, 5), std::vector<double>{1});
}

TEST(Ticks, RoundLengthIsTheLargestOfOneTwoFive) {
  EXPECT_EQ(round_length(1000), 1000);
  EXPECT_EQ(round_length(999), 500);
  EXPECT_EQ(round_length(0.3), 0.2);
  EXPECT_EQ(round_length(0.001), 0.001);
}

TEST(Ticks, LabelsTellNeighboursApart) {
  EXPECT_EQ(label(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(label(-150, 50), "\u2212150");
  EXPECT_EQ(label(1e-17, 0.1), "0");
  EXPECT_EQ(label(1000.5, 0.5), "1000.5");
  EXPECT_EQ(label(200, 200), "200");
  EXPECT_EQ(label(-400, 200), "\u2212400");
  EXPECT_EQ(label(10, 5), "10");
  EXPECT_EQ(label(0.0002, 0.0001), "0.0002");
  EXPECT_EQ(label(2e7, 1e7), "2e+07");
}

}  // namespace
}  // namespace marrow
