// Where the rays of a camera are few, cells are larger, and the surface stays where it is.
#include "field/trace/ray_spacing.h"

#include <array>
#include <cmath>
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

}  // namespace
}  // namespace marrow::test
