// Durations and pieces: what is read is what was meant, and nothing else is read.
#include "renderer/app/text/text.h"

#include <gtest/gtest.h>

namespace marrow {
namespace {

TEST(Duration, AddsHoursMinutesAndSeconds) {
  EXPECT_EQ(parse_duration("90"), 90);
  EXPECT_EQ(parse_duration("90s"), 90);
  EXPECT_EQ(parse_duration("10m"), 600);
  EXPECT_EQ(parse_duration("1h30m"), 5400);
  EXPECT_EQ(parse_duration("1h0.5s"), 3600.5);
  for (const auto* wrong : {"", "s", "-1s", "0", "1s1h", "1m1m", "1d", "ten", "1h-1m"})
    EXPECT_FALSE(parse_duration(wrong)) << wrong;
}

TEST(Split, GivesOnePieceMoreThanSeparators) {
  EXPECT_EQ(split("a,,b", ',').size(), 3u);
  EXPECT_EQ(split("", ',').size(), 1u);
  EXPECT_EQ(split("a,", ',').back(), "");
}

TEST(Counted, AddsAnSUnlessOne) {
  EXPECT_EQ(counted(0, "object"), "0 objects");
  EXPECT_EQ(counted(1, "object"), "1 object");
  EXPECT_EQ(counted(2, "object"), "2 objects");
}

}  // namespace
}  // namespace marrow
