// The share of angles where floats do not tell the field of all strands but the strongest.
#include "field/trace/cells/weak_strands.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "field/trace/cells/block.h"
#include "tests/trace/crowd.h"

namespace marrow::test {
namespace {

// A thick strand beside a thin one far away, whose field is small in floats or vanishes there: alpha is that of the
// pair all the same.
void expect_weak_others_tell_the_angle(Random random, const auto& bounds_of) {
  struct Pair {
    int degree;
    double distance, thin;
  };
  for (const auto& [degree, distance, thin] : {Pair{4, 3, 0.05}, Pair{6, 10, 0.001}, Pair{8, 10, 0.002},
                                               Pair{12, 10, 0.01}, Pair{12, 100, 0.001}, Pair{20, 20, 0.01}}) {
    BlendField blend = random_scene(random, {degree, 1}, 0);
    const auto add = [&](const Vec3d& middle, const Vec3d& half, double radius) {
      blend.segments.strands.push_back(static_cast<std::uint32_t>(blend.direction_bounds.size()));
      blend.segments.add({middle - half, middle + half, radius, radius}, {});
      blend.direction_bounds.push_back(bounds_of(blend.direction_bounds.size()));
    };
    add({0, 0, 0}, {0.05, 0, 0}, 0.1);
    add(random_direction(random) * distance, normalize(Vec3d{1, 0.2, 0}).vec() * (2 * thin), thin);
    const Crowd crowd(std::move(blend));
    int places = 0;
    double largest = 0;
    for (std::size_t i = 0; i < crowd.stage.cells.size(); ++i) {
      const Block block(crowd.context, crowd.stage.cells[i]);
      if (length(block.center()) > 0.5) continue;
      for (int k = 0; k < 20; ++k) {
        const Vec3d x = random.vector(1);
        const BlendSample exact = evaluate(crowd.stage.field, block.center() + x * block.half());
        if (std::fabs(exact.corrected - 1) > 0.2) continue;
        ++places;
        largest = std::max(largest, std::fabs(block.share(x).share - exact_share(crowd, exact)));
      }
    }
    std::cout << "  degree " << degree << ": " << places << " places, shares are off by " << largest << " at most\n";
    EXPECT_GT(places, 10);
    EXPECT_LT(largest, 3e-5) << "degree " << degree << " distance " << distance << " radius " << thin;
  }
}

TEST(WeakStrands, TellTheAngle) {
  expect_weak_others_tell_the_angle(Random(96), [](std::size_t) { return strand_bounds; });
}

TEST(WeakStrands, TellTheAngleByBoundsOfTheirOwn) {
  expect_weak_others_tell_the_angle(Random(101), [](std::size_t strand) {
    return strand == 0 ? DirectionBounds{0.2, 0.9} : DirectionBounds{1.4, 0.7};
  });
}

// In balls beside one strand and between several, of several segments each.
TEST(WeakStrands, FewOfThemCount) {
  Random random(97);
  for (const int degree : {4, 8, 20}) {
    BlendField blend = random_scene(random, {degree, 1}, 0);
    constexpr int count = 300;
    for (int k = 0; k < count; ++k) {
      const Vec3d middle = random.vector(1), half = random_direction(random) * 0.02, turn = random.vector(0.02);
      blend.segments.add({middle - half, middle, 0.01, 0.01}, {});
      blend.segments.add({middle, middle + half + turn, 0.01, 0.004}, {});
      blend.segments.strands.insert(blend.segments.strands.end(), 2, static_cast<std::uint32_t>(k));
      blend.direction_bounds.push_back(strand_bounds);
    }
    const auto range = angle_range(blend);
    ASSERT_TRUE(range);
    double largest = 0, steepest = 0;
    std::size_t kept = 0;
    constexpr int balls = 40;
    for (int i = 0; i < balls; ++i) {
      const double reach = 0.01;
      const Vec3d center = i % 2 == 0
                               ? random.vector(1)
                               : blend.segments.skeletons[static_cast<std::size_t>(2 * i)].from + random.vector(0.03);
      const BlendField few = counting_strands(blend, center, reach);
      kept += few.direction_bounds.size();
      for (int k = 0; k < 5; ++k) {
        const Vec3d p = center + random_direction(random) * reach;
        const AngleShare by_all = exact_share(blend, *range, p), by_few = exact_share(few, *range, p);
        largest = std::max(largest, std::fabs(by_all.value - by_few.value));
        steepest = std::max(steepest, length(by_all.gradient - by_few.gradient) * reach);
      }
    }
    const double mean = static_cast<double>(kept) / balls;
    std::cout << "  degree " << degree << ": " << mean << " of " << count << " strands count, shares differ by "
              << largest << ", over the ball by slopes by " << steepest << "\n";
    EXPECT_LE(largest, 1e-6) << "degree " << degree;
    EXPECT_LE(steepest, 1e-5) << "degree " << degree;
    EXPECT_LT(mean, degree == 20 ? count / 3 : count + 1) << "degree " << degree;
  }
}

}  // namespace
}  // namespace marrow::test
