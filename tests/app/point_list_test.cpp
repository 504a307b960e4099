// Points are read without loss; bad lines are all told.
#include "renderer/app/input/point_list.h"

#include <random>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace marrow {
namespace {

Result<std::vector<Vec3d>> read(const std::string& text) {
  std::istringstream in(text);
  SourceCache sources;
  return read_points(in, "points", sources);
}

TEST(PointList, GivesBackWhatWasWritten) {
  constexpr unsigned seed = 5;
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> exponent(-30, 30);
  std::vector<Vec3d> points;
  std::string text;
  for (int i = 0; i < 1000; ++i) {
    const auto number = [&] {
      return (random() % 2 ? 1 : -1) * std::ldexp(1 + exponent(random) / 31, static_cast<int>(exponent(random)));
    };
    const Vec3d p{number(), number(), number()};
    points.push_back(p);
    text += fmt::format("{:.17g}\t{:.17g}  {:.17g}\r\n", p.x, p.y, p.z);
  }
  const auto found = read(text);
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, points);
}

TEST(PointList, SkipsEmptyLinesAndComments) {
  const auto found = read("\n# nothing\n  \n1 2 3\n   # more\n4 5 6");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->size(), 2u);
  EXPECT_TRUE(read("")->empty());
  EXPECT_EQ(read("\xEF\xBB\xBF"
                 "1 2 3\n")
                ->front(),
            (Vec3d{1, 2, 3}));
}

TEST(PointList, TellsEveryBadLineWithItsPlace) {
  const auto found = read("1 2 3\n1 2\n1 x 3\n1 2 3 4\n");
  ASSERT_FALSE(found);
  ASSERT_EQ(found.why().size(), 3u);
  EXPECT_EQ(found.why()[0].where, (SourceLocation{"points", 2, 1}));
  EXPECT_EQ(found.why()[1].where, (SourceLocation{"points", 3, 3}));
  EXPECT_EQ(found.why()[2].where, (SourceLocation{"points", 4, 1}));
}

}  // namespace
}  // namespace marrow
