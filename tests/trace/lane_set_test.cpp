// Sets of the lanes of a packet: across words of 64, and in groups as wide as registers.
#include "field/math/lane_set.h"

#include <vector>

#include <gtest/gtest.h>

namespace marrow::test {
namespace {

constexpr auto size = static_cast<std::size_t>(packet_size);

std::vector<int> lanes_of(const LaneSet& set) {
  std::vector<int> lanes;
  set.for_each([&](int lane) { lanes.push_back(lane); });
  return lanes;
}

TEST(LaneSet, RangesCrossWords) {
  EXPECT_TRUE(LaneSet().empty());
  EXPECT_EQ(LaneSet::range(0, size).count(), packet_size);
  const LaneSet set = LaneSet::range(62, 5);
  EXPECT_EQ(lanes_of(set), (std::vector{62, 63, 64, 65, 66}));
  EXPECT_EQ(set.lowest(), 62);
  EXPECT_EQ((~set).count(), packet_size - 5);
  EXPECT_TRUE((set & ~set).empty());
  EXPECT_EQ(lanes_of((set | LaneSet::range(0, 1)) & LaneSet::range(0, 64)), (std::vector{0, 62, 63}));
}

TEST(LaneSet, LanesComeAndGo) {
  LaneSet set;
  for (const std::size_t lane : {size - 1, std::size_t{64}, std::size_t{3}}) set.add(lane);
  EXPECT_TRUE(set.has(64));
  set.remove(64);
  EXPECT_FALSE(set.has(64));
  EXPECT_EQ(lanes_of(set), (std::vector{3, packet_size - 1}));
}

TEST(LaneSet, TakesTheLowest) {
  LaneSet set = LaneSet::range(60, 20);
  std::vector<int> taken;
  set.take(6, [&](int lane) { taken.push_back(lane); });
  EXPECT_EQ(taken, (std::vector{60, 61, 62, 63, 64, 65}));
  EXPECT_EQ(set.lowest(), 66);
  set.take(packet_size, [&](int lane) { taken.push_back(lane); });
  EXPECT_EQ(taken.size(), 20u);
  EXPECT_TRUE(set.empty());
}

TEST(LaneSet, GroupsAreThoseWithLanes) {
  LaneSet set;
  set.add(5);
  set.add_group(size - 16, 0x8001);
  std::vector<int> groups;
  set.for_each_group<16>([&](int first) { groups.push_back(first); });
  EXPECT_EQ(groups, (std::vector{0, packet_size - 16}));
  EXPECT_EQ(set.group<16>(0), 0x20u);
  EXPECT_EQ(set.group<16>(size - 16), 0x8001u);
  EXPECT_EQ(set.group<4>(4), 2u);
}

}  // namespace
}  // namespace marrow::test
