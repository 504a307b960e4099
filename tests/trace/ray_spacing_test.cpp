// Where the rays of a camera are few, cells are larger, and the surface stays where it is.
#include "field/trace/ray_spacing.h"

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "field/trace/blend_tracer.h"
#include "tests/trace/first_of_tiles.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

RaySpacing seen_from(const Vec3d& eye, bool come_once) {
  return {.views = {{.eye = eye, .constant = 0, .per_distance = 0.002}}, .come_once = come_once};
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
  RaySpacing spacing = seen_from({0, 0, 9}, false);
  const double alone = spacing.in_cube({0, 0, 0}, 0.1);
  spacing.views.resize(100, spacing.views.front());
  EXPECT_NEAR(spacing.in_cube({0, 0, 0}, 0.1), alone / 10, 1e-12);
  spacing.views.resize(1'000'000, spacing.views.front());  // of which a part is asked
  EXPECT_NEAR(spacing.in_cube({0, 0, 0}, 0.1), alone / 1000, 1e-2 * alone / 1000);
}

TEST(RaySpacing, CellsAreLargerWhereRaysComeOnce) {
  const RaySpacing often = seen_from({0, 0, 9}, false), once = seen_from({0, 0, 9}, true);
  EXPECT_GT(once.least_cell({0, 0, 0}, 0.1), often.least_cell({0, 0, 0}, 0.1));
}

// Grazing rays aside, on which hits may part where the field hardly exceeds 1.
TEST(RaySpacing, LargerCellsHoldTheSameSurface) {
  Random random(82);
  const BlendField blend = random_scene(random, {4, contact_alpha(4)}, 9);
  std::array<std::unique_ptr<BlendTracer>, 3> tracers;
  std::size_t blocks[3];
  for (std::size_t k = 0; k < 3; ++k) {
    TraceOptions options;
    if (k > 0) options.spacing = std::make_shared<const RaySpacing>(seen_from({0, 0, 9}, k == 2));
    tracers[k] = std::move(*BlendTracer::make(blend, options));
  }
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = chord(random);
    const auto expected = first_hit(*tracers[0], ray);
    for (std::size_t k = 1; k < 3; ++k) {
      const auto found = first_hit(*tracers[k], ray);
      if (!expected || !found) {
        const auto grazing = expected ? expected : found;
        if (grazing) { EXPECT_NEAR(corrected_value(blend, ray.at(*grazing + 1e-4)), 1, 1e-4); }
        continue;
      }
      EXPECT_NEAR(corrected_value(blend, ray.at(*found)), 1, 2e-5);
      hits += std::fabs(*found - *expected) < 1e-5;
    }
  }
  EXPECT_GT(hits, 1000);
  for (std::size_t k = 0; k < 3; ++k) blocks[k] = tracers[k]->statistics().blocks;
  EXPECT_GT(blocks[0], blocks[1]);
  EXPECT_GT(blocks[1], blocks[2]);
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
  options.spacing = std::make_shared<const RaySpacing>(seen_from({0, 0, 9}, false));
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
