// A crop names a part of the film that exists.
#include "renderer/app/command_line/crop.h"

#include <gtest/gtest.h>

namespace marrow {
namespace {

PixelWindow window_of(const std::string& text, int width, int height) {
  const auto crop = parse_crop(text);
  EXPECT_TRUE(crop) << text;
  const auto window = resolve(*crop, width, height);
  EXPECT_TRUE(window) << text;
  return *window;
}

TEST(Crop, TakesPixelsAndPercent) {
  EXPECT_EQ(window_of("10,20,30,40", 100, 80), (PixelWindow{10, 20, 30, 40}));
  EXPECT_EQ(window_of("25%,25%,75%,75%", 100, 80), (PixelWindow{25, 20, 75, 60}));
  EXPECT_EQ(window_of("0,0,50%,7", 9, 9), (PixelWindow{0, 0, 5, 7}));
}

TEST(Crop, IsClippedToTheFilm) { EXPECT_EQ(window_of("-5,-5,1000,1000", 64, 48), (PixelWindow{0, 0, 64, 48})); }

TEST(Crop, NeighboursInPercentMeetWithoutGapOrOverlap) {
  for (int width = 1; width < 200; ++width)
    for (const auto* middle : {"33%", "50%", "66.6%"}) {
      const auto crop = parse_crop(std::string("0,0,") + middle + ",100%");
      const auto rest = parse_crop(std::string(middle) + ",0,100%,100%");
      const auto left = resolve(*crop, width, 10), right = resolve(*rest, width, 10);
      if (left && right) { EXPECT_EQ(left->x1, right->x0) << width << " " << middle; }
      EXPECT_TRUE(left || right);
    }
}

TEST(Crop, WithoutPixelsIsRefused) {
  for (const auto* empty : {"5,5,5,9", "9,9,5,5", "200,0,300,10"})
    EXPECT_FALSE(resolve(*parse_crop(empty), 100, 100)) << empty;
  for (const auto* wrong : {"", "1,2,3", "1,2,3,4,5", "a,b,c,d", "1.5,0,3,3", "0,0,%,5", "0,0,1e99,5"})
    EXPECT_FALSE(parse_crop(wrong)) << wrong;
}

}  // namespace
}  // namespace marrow
