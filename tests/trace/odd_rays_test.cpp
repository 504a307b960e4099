// Rays as no camera makes them: directions that are all but parallel to axes, and beginnings exactly in skeletons.
#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "tests/trace/first_of_tiles.h"
#include "tests/trace/oracle.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

// What products of sines and cosines leave of 0, of either sign; also what no float holds, and 0 itself.
double next_to_nothing(Random& random) {
  constexpr double sizes[] = {0, 1e-320, 1e-45, 1e-39, 1e-30, 1e-21, 1e-19};
  const double size = sizes[random.whole(0, 6)];
  return random.between(0, 1) < 0.5 ? -size : size;
}

TEST(OddRays, ANegligibleComponentChangesNothing) {
  Random random(301);
  int hits = 0;
  for (int scene = 0; scene < 6; ++scene) {
    const BlendField blend = random_scene(random, {random.whole(3, 6), 0.8}, 4);
    const auto tracer = std::move(*BlendTracer::make(blend, {}));
    for (int i = 0; i < 1000; ++i) {
      const Ray straight = along_axis(random);
      Vec3d direction = straight.direction;
      for (std::size_t k = 0; k < 3; ++k)
        if (direction[k] == 0) direction[k] = next_to_nothing(random);
      const auto expected = first_hit(*tracer, straight),
                 found = first_hit(*tracer, {straight.origin, UnitVec3::unchecked(direction)});
      ASSERT_EQ(expected.has_value(), found.has_value()) << direction.x << ' ' << direction.y << ' ' << direction.z;
      if (!expected) continue;
      ++hits;
      EXPECT_NEAR(*expected, *found, 1e-12);
    }
  }
  EXPECT_GT(hits, 1000);
}

TraceOptions large_cells() {
  RaySpacing few;
  few.views.push_back({.eye = {}, .constant = std::numeric_limits<double>::infinity()});
  TraceOptions options;
  options.spacing = std::make_shared<const RaySpacing>(few);
  return options;
}

// High degrees make fields beside a skeleton larger than floats can hold.
TEST(OddRays, RaysThatBeginInASkeletonLeave) {
  Random random(302);
  int rays = 0;
  for (const int n : {3, 6, 9, 12, 20})
    for (const double alpha : {0.0, contact_alpha(n), 1.45, std::numbers::pi / 2}) {
      const BlendField field = random_scene(random, {n, alpha}, 5);
      const Oracle oracle(field);
      const auto tracer =
          std::move(*BlendTracer::make(field, random.whole(0, 1) == 0 ? TraceOptions{} : large_cells()));
      for (const SegmentSkeleton& s : field.segments.skeletons)
        for (int i = 0; i < 8; ++i) {
          const Vec3d from = i % 2 == 0 ? s.from : lerp(s.from, s.to, random.between(0, 1));
          const Ray ray{from, UnitVec3::unchecked(random_direction(random))};
          const auto exit = first_hit(*tracer, ray);
          ASSERT_TRUE(exit) << "n " << n << " alpha " << alpha;
          ++rays;
          const double t = *exit, slack = 1e-4 * oracle.skeleton_distance(ray.at(t));
          EXPECT_GT(t, 10 * slack) << "n " << n << " alpha " << alpha;
          EXPECT_LT(oracle.largest_deficit(ray, 1e-9, t - slack), 1e-5) << "n " << n << " alpha " << alpha;
          EXPECT_LT(oracle.value(ray.at(t + slack)), 1 + 1e-5) << "n " << n << " alpha " << alpha;
        }
    }
  EXPECT_GT(rays, 300);
}

}  // namespace
}  // namespace marrow::test
