// Places that are told to be clearly outside are, and most of those that are get told.
#include "field/trace/outside_bound.h"

#include <cmath>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/trace/stage.h"

namespace marrow::test {
namespace {

// Around one of its skeletons, some radii away at most.
Vec3d beside(Random& random, const BlendField& blend) {
  const auto& all = blend.segments.skeletons;
  const auto& s = all[static_cast<std::size_t>(random.whole(0, static_cast<int>(all.size()) - 1))];
  const double at = random.between(0, 1), radius = s.radius_from + (s.radius_to - s.radius_from) * at;
  return lerp(s.from, s.to, at) + random_direction(random) * (radius * random.between(0.9, 2));
}

struct Count {
  int told = 0, outside = 0, wrong = 0;
};

Count count_told(Random& random, const Stage& stage, int places) {
  const OutsideBound bound(stage.sources, stage.coarse, stage.iso);
  Count c;
  for (int i = 0; i < places; ++i) {
    const Vec3d p = beside(random, stage.field);
    const double value = stage.value(p);
    const bool told = bound.holds(p);
    c.wrong += told && !(value < 1 - OutsideBound::clearly_below);
    c.outside += value < 0.95;
    c.told += told && value < 0.95;
  }
  return c;
}

TEST(OutsideBound, IsNeverWrong) {
  Random random(301);
  Count all;
  for (const int n : {3, 4, 5, 6, 8})
    for (const double alpha : {-0.4, -0.1, 0.0, 0.3, contact_alpha(n), 1.3, 1.5, std::numbers::pi / 2})
      for (const bool cavity : {true, false})
        for (const Projection projection : {Projection::Paper, Projection::Exact}) {
          if (!cavity && alpha <= 0) continue;  // no such blends
          const Stage stage(random_scene(random, {n, alpha, cavity, projection}, 12));
          const Count c = count_told(random, stage, 500);
          EXPECT_EQ(c.wrong, 0) << "n = " << n << ", alpha = " << alpha;
          all.told += c.told;
          all.outside += c.outside;
        }
  std::cout << "  " << all.told << " of " << all.outside << " told\n";
  EXPECT_GT(all.outside, 30'000);
  EXPECT_GT(all.told, 9 * all.outside / 10);
}

TEST(OutsideBound, IsToldOfMostPlacesAmongMany) {
  Random random(302);
  const Stage stage(random_scene(random, {4, contact_alpha(4)}, 400));
  const OutsideBound bound(stage.sources, stage.coarse, stage.iso);
  int told = 0, outside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p = random_direction(random) * random.between(0, 6);
    const double value = stage.value(p);
    const bool is_told = bound.holds(p);
    EXPECT_FALSE(is_told && value > 1 - OutsideBound::clearly_below);
    outside += value < 0.95;
    told += is_told && value < 0.95;
  }
  std::cout << "  " << told << " of " << outside << " told\n";
  EXPECT_GT(outside, 500);
  EXPECT_GT(told, 9 * outside / 10);
}

}  // namespace
}  // namespace marrow::test
