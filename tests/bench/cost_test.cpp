// What is too short to tell is not told, and what is long enough is.
#include "renderer/bench/cost.h"

#include <gtest/gtest.h>

namespace marrow {
namespace {

TEST(Costs, OfWholeWorksTellFromSomeMilliseconds) {
  EXPECT_FALSE(whole_costs({}).wall_tells);
  const Costs costs = whole_costs({{.004, .004}, {.006, .004}, {.007, .009}});
  EXPECT_TRUE(costs.wall_tells);
  EXPECT_FALSE(costs.cpu_tells);
  EXPECT_EQ(median(costs).wall_s, .006);
  EXPECT_FALSE(median(costs).cpu_s);
}

// The part that is told is the exact difference over the number of parts.
TEST(Costs, OfMoreWorkAreDifferences) {
  const Costs costs = further_costs({{.shorter = {1, 2}, .longer = {4, 8}}}, 15);
  EXPECT_DOUBLE_EQ(median(costs).wall_s.value(), 3.0 / 15);
  EXPECT_DOUBLE_EQ(median(costs).cpu_s.value(), 6.0 / 15);
}

TEST(Costs, OfMoreWorkDoNotTellWhenTheyDrownInTheRest) {
  struct Case {
    double shorter, longer;
    bool tells;
  };
  // Noise made it negative; nothing; a fifth and less; more than a fifth; all too short
  for (const Case& c : {Case{1, .9, false}, {1, 1, false}, {.8, .999, false}, {.8, 1.01, true}, {1e-4, 4e-3, false}}) {
    const Costs costs = further_costs({{.shorter = {c.shorter, 1}, .longer = {c.longer, 2}}}, 15);
    EXPECT_EQ(costs.wall_tells, c.tells) << c.shorter << ' ' << c.longer;
    EXPECT_EQ(median(costs).wall_s.has_value(), c.tells);
    EXPECT_TRUE(costs.cpu_tells);
  }
}

// One round that a neighbour disturbed does not hide the others.
TEST(Costs, AreJudgedByTheirMedians) {
  const TwoRuns good{.shorter = {1, 1}, .longer = {4, 4}}, disturbed{.shorter = {9, 9}, .longer = {4, 4}};
  const Costs costs = further_costs({good, disturbed, good}, 15);
  EXPECT_TRUE(costs.wall_tells);
  EXPECT_DOUBLE_EQ(median(costs).wall_s.value(), .2);
}

TEST(Ratio, NeedsTwoWorksThatTell) {
  const Costs one = whole_costs({{1, 1}}), two = whole_costs({{2, 1e-4}}), none = whole_costs({});
  EXPECT_DOUBLE_EQ(median_ratio(two, one).wall.value(), 2);
  EXPECT_DOUBLE_EQ((median_ratio(two, one) * 3).wall.value(), 6);
  EXPECT_FALSE(median_ratio(two, one).cpu);
  EXPECT_FALSE(median_ratio(one, two).cpu);
  EXPECT_FALSE(median_ratio(one, none).wall);
  EXPECT_FALSE((median_ratio(one, none) * 3).wall);
}

}  // namespace
}  // namespace marrow
