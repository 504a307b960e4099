// Places that are told to be clearly outside or inside are, and most of those that are get told.
#include "field/trace/side_bound.h"

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
  return lerp(s.from, s.to, at) + random_direction(random) * (radius * random.between(0, 2));
}

// Places on one side by more than a twentieth, and those of them that are told to be there.
struct Count {
  int there = 0, told = 0;
  void add(bool is_there, bool is_told) {
    there += is_there;
    told += is_there && is_told;
  }
};

struct Counts {
  Count outside, inside;
  int wrong = 0;

  void add(double value, Side told) {
    wrong += told == Side::Outside && !(value < 1 - SideBound::clearly);
    wrong += told == Side::Inside && !(value > 1 + SideBound::clearly);
    outside.add(value < 0.95, told == Side::Outside);
    inside.add(value > 1.05, told == Side::Inside);
  }
};

void expect_most_told(const Count& c, int least) {
  std::cout << "  " << c.told << " of " << c.there << " told\n";
  EXPECT_GT(c.there, least);
  EXPECT_GT(c.told, 9 * c.there / 10);
}

TEST(SideBound, IsNeverWrong) {
  Random random(301);
  Counts all;
  for (const int n : {3, 4, 5, 6, 8})
    for (const double alpha : {-0.4, -0.1, 0.0, 0.3, contact_alpha(n), 1.3, 1.5, std::numbers::pi / 2})
      for (const bool cavity : {true, false})
        for (const Projection projection : {Projection::Paper, Projection::Exact}) {
          if (!cavity && alpha <= 0) continue;  // no such blends
          const Stage stage(random_scene(random, {n, alpha, cavity, projection}, 12));
          const SideBound bound(stage.sources, stage.coarse, stage.iso);
          for (int i = 0; i < 500; ++i) {
            const Vec3d p = beside(random, stage.field);
            all.add(stage.value(p), bound.side(p));
          }
          EXPECT_EQ(all.wrong, 0) << "n = " << n << ", alpha = " << alpha;
        }
  expect_most_told(all.outside, 10'000);
  expect_most_told(all.inside, 10'000);
}

TEST(SideBound, IsToldOfMostPlacesAmongMany) {
  Random random(302);
  const Stage stage(random_scene(random, {4, contact_alpha(4)}, 400));
  const SideBound bound(stage.sources, stage.coarse, stage.iso);
  Counts all;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p = i % 2 == 0 ? random_direction(random) * random.between(0, 6) : beside(random, stage.field);
    all.add(stage.value(p), bound.side(p));
  }
  EXPECT_EQ(all.wrong, 0);
  expect_most_told(all.outside, 500);
  expect_most_told(all.inside, 500);
}

// Of boxes of a tenth to several radii around such places, by places in them.
TEST(SideBound, TellsAllOfABox) {
  Random random(303);
  int outside = 0, inside = 0;
  for (const int n : {3, 5, 8}) {
    const Stage stage(random_scene(random, {n, contact_alpha(n)}, 40));
    const SideBound bound(stage.sources, stage.coarse, stage.iso);
    for (int i = 0; i < 3000; ++i) {
      const Vec3d center = i % 3 == 0 ? random_direction(random) * random.between(0, 4) : beside(random, stage.field);
      const Vec3d half = Vec3d{1, 1, 1} * pow(10, random.between(-3, 0));
      const Side side = bound.side({center - half, center + half});
      outside += side == Side::Outside;
      inside += side == Side::Inside;
      for (int k = 0; k < 8 && side != Side::Unknown; ++k) {
        const double value = stage.value(center + random.vector(half.x));
        EXPECT_TRUE(side == Side::Outside ? value < 1 : value > 1) << value;
      }
    }
  }
  std::cout << "  " << outside << " outside, " << inside << " inside\n";
  EXPECT_GT(outside, 1000);
  EXPECT_GT(inside, 500);
}

}  // namespace
}  // namespace marrow::test
