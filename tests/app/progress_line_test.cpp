// What a terminal shows while a picture is made.
#include "renderer/app/report/progress_line.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace marrow {
namespace {

TEST(Clock, ReadsLikeAClock) {
  EXPECT_EQ(clock_text(0), "0 s");
  EXPECT_EQ(clock_text(59.4), "59 s");
  EXPECT_EQ(clock_text(59.6), "1:00");
  EXPECT_EQ(clock_text(3599.9), "1:00:00");
  EXPECT_EQ(clock_text(7384), "2:03:04");
  EXPECT_EQ(clock_text(-1), "0 s");
}

TEST(Bar, FitsEveryTerminal) {
  for (int columns = 1; columns < 200; ++columns)
    for (const std::uint64_t done : {0, 1, 50, 99, 100}) {
      const Progress p{.done = done, .total = 100, .elapsed_s = 7384, .left_s = 99999, .samples_per_pixel = 4096};
      EXPECT_LT(bar_text(p, columns).size(), static_cast<std::size_t>(std::max(columns, 1)) + (columns == 1))
          << columns;
    }
}

TEST(Bar, TellsOfTheTimeWhereThatEndsFirst) {
  const Progress p{.done = 10, .total = 1000, .elapsed_s = 5, .left_s = 5, .limit_s = 10};
  EXPECT_NE(bar_text(p, 100).find(" 50 %"), std::string::npos);
  EXPECT_NE(bar_text({.done = 900, .total = 1000, .elapsed_s = 5, .limit_s = 10}, 100).find(" 90 %"),
            std::string::npos);
}

TEST(Bar, GrowsAndIsFullOnlyAtTheEnd) {
  std::ptrdiff_t before = 0;
  for (std::uint64_t done = 0; done <= 1000; ++done) {
    const auto text = bar_text({.done = done, .total = 1000}, 100);
    const auto full = std::count(text.begin(), text.end(), '#');
    EXPECT_GE(full, before);
    EXPECT_EQ(text.find('.') == std::string::npos, done == 1000);
    EXPECT_EQ(text.find("100 %") != std::string::npos, done == 1000);
    before = full;
  }
}

}  // namespace
}  // namespace marrow
