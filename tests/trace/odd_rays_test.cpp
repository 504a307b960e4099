// Rays as no camera makes them: directions that are all but parallel to axes, and beginnings exactly in skeletons.
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "tests/trace/first_of_tiles.h"
#include "tests/trace/large_cells.h"
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

// Where the operator changes its branch the curve that the tracer reads has a kink.
TEST(OddRays, HitsAtTheBorderOfTheCavityBranchLieOnTheSurface) {
  Random random(303);
  double largest = 0;
  int borders = 0;
  for (const int n : {3, 4, 5}) {
    BlendField field;
    field.degree = n;
    field.alpha = contact_alpha(n) + 2e-4;
    field.segments.add({{-1.3, 0, -0.4}, {1.3, 0, -0.4}, 0.4, 0.4}, {});
    field.segments.add({{-1.3, -0.25, 0.4}, {1.3, 0.25, 0.4}, 0.4, 0.4}, {});
    const Oracle oracle(field);
    const Correction c = correction_of(field);
    const auto tracer = std::move(*BlendTracer::make(field, {}));
    for (int i = 0; i < 3000; ++i) {
      const Vec3d eye = random_direction(random) * 3.0;
      const auto in_branch = [&](const Vec3d& target) -> std::optional<bool> {
        const Ray ray{eye, normalize(target - eye)};
        const auto t = first_hit(*tracer, ray);
        if (!t) return {};
        const BlendSample s = evaluate(field, ray.at(*t));
        largest = std::max(largest, oracle.displacement(ray.at(*t)));
        return c.in_cavity_branch(s.sum, s.si_norm);
      };
      Vec3d a = random.vector(0.3), b = random.vector(0.3);
      if (in_branch(a) != true || in_branch(b) != false) continue;
      for (int halving = 0; halving < 14; ++halving) {
        const Vec3d middle = (a + b) * 0.5;
        (in_branch(middle) == true ? a : b) = middle;
      }
      borders += in_branch(b) == false;
    }
  }
  std::cout << "  " << borders << " places of the border; largest displacement " << largest << '\n';
  EXPECT_GT(borders, 60);
  EXPECT_LT(largest, 5e-6);
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

// Without cavity correction and at small angles |grad_S f| is large deep inside, beyond the end of the table, which
// counted as outside: 10^5 samples were taken by the shortest steps.
TEST(OddRays, RaysFromDeepInsideTakeFewSamples) {
  Random random(304);
  int rays = 0;
  for (const int n : {3, 5, 8})
    for (const double alpha : {0.5, 0.9}) {
      const BlendField field = random_scene(random, {n, alpha, false}, 5);
      const Oracle oracle(field);
      const auto tracer = std::move(*BlendTracer::make(field, large_cells()));
      for (const SegmentSkeleton& s : field.segments.skeletons)
        for (int i = 0; i < 30; ++i) {
          const Vec3d from = lerp(s.from, s.to, random.between(0, 1)) + random.vector(0.8 * s.radius_from);
          if (oracle.value(from) < 1.01) continue;
          const Ray ray{from, UnitVec3::unchecked(random_direction(random))};
          ++rays;
          for (std::size_t tile = 0; tile < tracer->tile_count(); ++tile) {
            CellLog log;
            tracer->first_hit(tile, ray, false, log);
            EXPECT_LT(log.evaluations, 1000U) << "n " << n << " alpha " << alpha;
          }
        }
    }
  EXPECT_GT(rays, 200);
}

// Parts of a cone near its thick end were bounded by the radius of its thin one, and errors of 10^9 stated.
TEST(OddRays, SteepConesAreKnownAsWellAsOthers) {
  Random random(303);
  for (int scene = 0; scene < 6; ++scene) {
    BlendField field = random_scene(random, {random.whole(3, 12), 0.7}, 1);
    const double thick = random.between(0.3, 0.5), thin = thick * pow(10, random.between(-3, -1));
    field.segments.add({random.vector(0.5), random.vector(0.5), thick, thin}, {});
    field.segments.add({random.vector(0.5), random.vector(0.5), thin, thick}, {});
    const auto tracer = std::move(*BlendTracer::make(field, large_cells()));
    int hits = 0, lifted = 0;
    for (int i = 0; i < 200; ++i) {
      const Ray ray = chord(random);
      std::optional<CellHit> first;
      for (std::size_t tile = 0; tile < tracer->tile_count(); ++tile) {
        CellLog log;
        const auto hit = tracer->first_hit(tile, ray, false, log);
        if (hit && (!first || hit->t < first->t)) first = hit;
      }
      if (!first) continue;
      ++hits;
      lifted += corrected_value(field, tracer->surface_at(*first->block, ray.at(first->t)).outside) < 1 - 1e-6;
    }
    EXPECT_GT(hits, 10);
    EXPECT_EQ(lifted, hits);
    EXPECT_LT(tracer->statistics().largest_error, 1e-4);
  }
}

}  // namespace
}  // namespace marrow::test
