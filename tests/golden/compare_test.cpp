// Laws of the comparison itself: a golden test is worth what it can see.
#include "tests/golden/compare.h"

#include <cmath>

#include <gmock/gmock.h>

namespace marrow {
namespace {

using ::testing::HasSubstr;

constexpr int width = 20, height = 10;

Picture flat(float value) {
  Picture p{{0, 0, width, height}, {0, 0, width, height}, {}, {}};
  for (const char* name : {"N.X", "N.Y", "Z"}) p.channels.push_back({name, std::vector<float>(width * height, value)});
  p.channels.push_back({"samples", std::vector<std::uint32_t>(width * height, 16)});
  return p;
}

float& sample(Picture& p, std::size_t channel, int x, int y) {
  return std::get<std::vector<float>>(p.channels[channel].samples)[static_cast<std::size_t>(y * width + x)];
}

Comparison compared(const Picture& got, const Picture& want, const Thresholds& t,
                    const std::vector<std::string>& names = {"N", "Z", "samples"}) {
  auto c = compare(got, want, names, t);
  if (!c) throw std::runtime_error(c.why().front().message);
  return *c;
}

TEST(GoldenCompare, EqualPicturesPassTheStrictestThresholds) {
  const Thresholds exact{.hard_fail = 0, .relative_mse = 0, .relative_mean = 0};
  const Comparison c = compared(flat(0.5f), flat(0.5f), exact);
  EXPECT_TRUE(c.passed());
  EXPECT_EQ(c.channels.size(), 4u);
}

TEST(GoldenCompare, OnePixelIsSeenAndNamed) {
  Picture got = flat(0.5f);
  sample(got, 2, 7, 3) += 0.25f;
  const Comparison c = compared(got, flat(0.5f), {.fail = 0.1});
  EXPECT_FALSE(c.passed());
  EXPECT_TRUE(c.channels[0].passed);
  EXPECT_FALSE(c.channels[2].passed);
  EXPECT_EQ(c.channels[2].largest, 0.25);
  EXPECT_EQ(c.channels[2].failed_percent, 0.5);
  EXPECT_EQ(c.channels[2].worst_x, 7);
  EXPECT_EQ(c.channels[2].worst_y, 3);
  EXPECT_EQ(std::get<std::vector<float>>(c.difference.channels[2].samples)[3 * width + 7], 0.25f);
  EXPECT_THAT(report(c, {}), HasSubstr("FAIL  Z"));
}

TEST(GoldenCompare, FailPercentAllowsAFewAndHardFailNone) {
  Picture got = flat(0.5f);
  sample(got, 2, 7, 3) += 0.25f;
  EXPECT_TRUE(compared(got, flat(0.5f), {.fail = 0.1, .fail_percent = 0.5}).passed());
  EXPECT_FALSE(compared(got, flat(0.5f), {.fail = 0.1, .fail_percent = 0.4}).passed());
  EXPECT_FALSE(compared(got, flat(0.5f), {.fail = 0.1, .fail_percent = 0.5, .hard_fail = 0.2}).passed());
}

TEST(GoldenCompare, BiasBelowTheThresholdOfPixelsIsSeenByTheMean) {
  const Picture got = flat(0.505f), want = flat(0.5f);
  EXPECT_TRUE(compared(got, want, {.fail = 0.01}).passed());
  EXPECT_FALSE(compared(got, want, {.fail = 0.01, .relative_mean = 0.005}).passed());
  const double expected = 0.005 * 0.005 / (0.25 + 0.01);
  EXPECT_NEAR(compared(got, want, {}).channels[0].relative_mse, expected, 1e-3 * expected);
}

TEST(GoldenCompare, InfinitiesMeetAndNotANumberNeverDoes) {
  Picture got = flat(1), want = flat(1);
  sample(got, 2, 0, 0) = sample(want, 2, 0, 0) = INFINITY;
  EXPECT_TRUE(compared(got, want, {.relative_mse = 0}).passed());
  sample(got, 2, 0, 0) = 1;
  EXPECT_FALSE(compared(got, want, {.fail = 1e30}).passed()) << "a hit where the reference has none";
  sample(got, 2, 0, 0) = sample(want, 2, 0, 0) = NAN;
  EXPECT_FALSE(compared(got, want, {.fail = 1e30}).passed()) << "NaN is no result even if expected";
}

TEST(GoldenCompare, WholeNumbersDoNotWrap) {
  Picture got = flat(1);
  std::get<std::vector<std::uint32_t>>(got.channels[3].samples)[0] = 15;
  EXPECT_EQ(compared(got, flat(1), {}).channels[3].largest, 1);
  EXPECT_FALSE(compared(got, flat(1), {}).passed());
}

TEST(GoldenCompare, RefusesWhatCannotBeCompared) {
  const std::vector<std::string> z = {"Z"}, colour = {"R"}, normals = {"N"}, none;
  Picture moved = flat(1), poor = flat(1);
  moved.data.x0 += 1;
  moved.data.x1 += 1;
  poor.channels.erase(poor.channels.begin());
  EXPECT_FALSE(compare(moved, flat(1), z, {}));
  EXPECT_FALSE(compare(flat(1), flat(1), colour, {}));
  EXPECT_FALSE(compare(flat(1), flat(1), none, {}));
  EXPECT_FALSE(compare(poor, flat(1), normals, {}));
  EXPECT_FALSE(compare(flat(1), poor, normals, {}));
}

}  // namespace
}  // namespace marrow
