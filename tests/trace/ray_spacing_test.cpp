// Where the rays of a camera are few, cells are larger, and the surface stays where it is.
#include "field/trace/cells/ray_spacing.h"

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "field/trace/blend_tracer.h"
#include "field/trace/cells/precision.h"
#include "tests/trace/first_of_tiles.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

RaySpacing seen_from(const Vec3d& eye, int samples) {
  return {.views = {{.eye = eye, .constant = 0, .per_distance = 0.002}}, .samples = samples};
}

TEST(RaySpacing, IsNowhereLessThanInTheCube) {
  Random random(81);
  for (int i = 0; i < 1000; ++i) {
    const RaySpacing spacing{.views = {{random.vector(5), random.between(0, 0.1), random.between(0, 0.1)},
                                       {random.vector(5), random.between(0, 0.1), random.between(0, 0.1)}}};
    const Vec3d center = random.vector(5);
    const double half = random.between(0.01, 2), least = spacing.in_cube(center, half);
    const Vec3d p = center + random.vector(half);
    for (const RaySpacing::View& v : spacing.views)
      EXPECT_LE(least, (v.constant + v.per_distance * length(p - v.eye)) * (1 + 1e-12));
  }
  EXPECT_EQ(RaySpacing{}.in_cube({1, 2, 3}, 0.5), 0);
  EXPECT_EQ(RaySpacing{}.least_cell({1, 2, 3}, 0.5), 0);
}

TEST(RaySpacing, RaysOfAllPlacementsComeTogether) {
  RaySpacing spacing = seen_from({0, 0, 9}, 0);
  const double alone = spacing.in_cube({0, 0, 0}, 0.1);
  spacing.views.resize(100, spacing.views.front());
  EXPECT_NEAR(spacing.in_cube({0, 0, 0}, 0.1), alone / 10, 1e-12);
  spacing.views.resize(1'000'000, spacing.views.front());  // of which a part is asked
  EXPECT_NEAR(spacing.in_cube({0, 0, 0}, 0.1), alone / 1000, 1e-2 * alone / 1000);
}

TEST(RaySpacing, CellsAreLargerWhereRaysComeOnce) {
  const RaySpacing often = seen_from({0, 0, 9}, 0), once = seen_from({0, 0, 9}, 1);
  EXPECT_GT(once.least_cell({0, 0, 0}, 0.1), often.least_cell({0, 0, 0}, 0.1));
}

TEST(RaySpacing, SlotsHaveEighthsWhereManyRaysComeToManyPieces) {
  const auto eighths = [](std::size_t pieces, int samples) {
    const RaySpacing spacing = seen_from({0, 0, 9}, samples);
    return have_eighths(pieces, &spacing);
  };
  EXPECT_TRUE(eighths(many_pieces, 64));
  EXPECT_TRUE(eighths(many_pieces, 0));
  EXPECT_TRUE(have_eighths(many_pieces, nullptr));
  EXPECT_FALSE(eighths(many_pieces, 1));
  EXPECT_FALSE(eighths(many_pieces, 4));
  EXPECT_FALSE(eighths(many_pieces - 1, 64));
  EXPECT_FALSE(eighths(too_many_pieces, 64));
}

std::unique_ptr<BlendTracer> tracer_of(const BlendField& blend, std::optional<RaySpacing> spacing) {
  TraceOptions options;
  if (spacing) options.spacing = std::make_shared<const RaySpacing>(*spacing);
  return std::move(*BlendTracer::make(blend, options));
}

// Of 2000 rays how many hit in the same place. Grazing rays aside hits may not part, where the field hardly exceeds 1.
int same_hits(Random& random, const BlendField& blend, const BlendTracer& one, const BlendTracer& other) {
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = chord(random);
    const auto expected = first_hit(one, ray), found = first_hit(other, ray);
    if (expected && found) {
      EXPECT_NEAR(corrected_value(blend, ray.at(*found)), 1, 2e-5);
      hits += std::fabs(*found - *expected) < 1e-5;
    } else if (const auto grazing = expected ? expected : found) {
      EXPECT_NEAR(corrected_value(blend, ray.at(*grazing + 1e-4)), 1, 1e-4);
    }
  }
  return hits;
}

TEST(RaySpacing, LargerCellsHoldTheSameSurface) {
  Random random(82);
  const BlendField blend = random_scene(random, {4, contact_alpha(4)}, 9);
  const auto all = tracer_of(blend, {}), few = tracer_of(blend, seen_from({0, 0, 9}, 0)),
             fewer = tracer_of(blend, seen_from({0, 0, 9}, 1));
  for (const BlendTracer* larger : {few.get(), fewer.get()}) EXPECT_GT(same_hits(random, blend, *all, *larger), 500);
  EXPECT_GT(all->statistics().blocks, few->statistics().blocks);
  EXPECT_GT(few->statistics().blocks, fewer->statistics().blocks);
}

// Rays are everywhere, so that cells are what they were, but all placements list the tiles.
TEST(RaySpacing, ManyPlacementsHaveLargerTiles) {
  Random random(84);
  const BlendField blend = random_scene(random, {4, contact_alpha(4)}, 9);
  const auto placed = [&](std::size_t times) {
    return tracer_of(blend,
                     RaySpacing{.views = std::vector<RaySpacing::View>(times, {.eye = {0, 0, 9}, .constant = 1e-9})});
  };
  const auto once = placed(1), often = placed(1000), very_often = placed(1'000'000);
  EXPECT_GT(once->tile_count(), 4 * often->tile_count());
  EXPECT_GE(often->tile_count(), very_often->tile_count());
  for (const BlendTracer* tracer : {often.get(), very_often.get()})
    EXPECT_GT(same_hits(random, blend, *once, *tracer), 500);
}

// Of threads far thinner than the gaps between rays cells may have many radii.
TEST(RaySpacing, CellsOfThinThreadsHoldTheSameSurface) {
  constexpr double radius = 0.002;
  Random random(83);
  BlendField blend;
  blend.alpha = contact_alpha(blend.degree);
  for (int i = 0; i < 60; ++i) {
    const Vec3d from = random.vector(1);
    blend.segments.add({from, from + random.vector(0.1), radius, 0.8 * radius}, {});
  }
  TraceOptions options;
  options.spacing = std::make_shared<const RaySpacing>(seen_from({0, 0, 9}, 0));
  const auto fine = std::move(*BlendTracer::make(blend, {})), few = std::move(*BlendTracer::make(blend, options));
  int hits = 0, misses = 0;
  for (std::size_t i = 0; i < 3000; ++i) {
    const SegmentSkeleton& s = blend.segments.skeletons[i % blend.segments.size()];
    const Ray ray =
        between(random_direction(random) * 5, lerp(s.from, s.to, random.between(0, 1)) + random.vector(2 * radius));
    const auto expected = first_hit(*fine, ray), found = first_hit(*few, ray);
    if (expected && found) {
      EXPECT_NEAR(corrected_value(blend, ray.at(*found)), 1, 5e-5) << "ray " << i;
      hits += std::fabs(*found - *expected) < 1e-4 * radius;
    } else if (const auto grazing = expected ? expected : found) {
      EXPECT_NEAR(corrected_value(blend, ray.at(*grazing + 1e-3 * radius)), 1, 1e-4) << "ray " << i;
    } else {
      ++misses;
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 300);
  EXPECT_LT(8 * few->statistics().blocks, fine->statistics().blocks);
  std::cout << "  " << hits << " hits, " << misses << " misses; blocks " << few->statistics().blocks << " instead of "
            << fine->statistics().blocks << '\n';
}

}  // namespace
}  // namespace marrow::test
