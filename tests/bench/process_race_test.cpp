// Whole processes: as many samples as are said, and an end when one is asked for.
#include "renderer/bench/process_race.h"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "renderer/bench/child_process.h"

namespace marrow {
namespace {

TEST(PovrayGrid, ComesNearest) {
  for (int n = 2; n <= 120; ++n) {
    const int k = povray_grid(n);
    EXPECT_GE(k, 1);
    EXPECT_LE(k, 9);  // it takes no larger grid
    for (int other = 1; other <= 9; ++other)
      EXPECT_LE(std::abs(samples_of_povray_grid(k) - n), std::abs(samples_of_povray_grid(other) - n)) << n;
  }
  EXPECT_EQ(povray_grid(16), 4);
  EXPECT_EQ(samples_of_povray_grid(povray_grid(17)), 17);
}

TEST(RunProgram, MeasuresWhatEndsWell) {
  const auto program = find_program("true");
  ASSERT_TRUE(program);
  EXPECT_TRUE(run_program(*program, {}));
  EXPECT_FALSE(run_program(find_program("false").value(), {}));
}

TEST(RunProgram, EndsWhenAskedTo) {
  std::atomic<bool> flag = false;
  const std::jthread asks([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    flag = true;
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(run_program(find_program("sleep").value(), {"60"}, {&flag}));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

}  // namespace
}  // namespace marrow
