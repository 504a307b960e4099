// Rays that end: hidden exactly when they reach the surface, by however little.
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "field/trace/blend_tracer.h"
#include "tests/trace/first_of_tiles.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

bool is_hidden(const BlendTracer& tracer, Ray ray, double t_max) {
  ray.t_max = t_max;
  for (std::size_t i = 0; i < tracer.tile_count(); ++i) {
    CellLog log;
    if (tracer.first_hit(i, ray, true, log)) return true;
  }
  return false;
}

// A ball, smaller and smaller ones on it: where they touch, cells know the field only roughly before they look closely.
struct BallsOnBalls {
  BlendField blend;
  Vec3d middle;
  UnitVec3 out;

  explicit BallsOnBalls(Random& random) : middle(random.vector(9)), out(normalize(random_direction(random))) {
    blend.degree = random.whole(3, 5);
    blend.alpha = random.between(1.1, 1.4);
    blend.cavity = false;
    double radius = 0.8, surface = radius;
    blend.points.add({middle, radius}, {});
    while (radius > 3e-4) {
      radius *= random.between(0.1, 0.4);
      surface += radius;
      blend.points.add({middle + out * surface, radius}, {});
    }
  }
  Ray ray(Random& random) const {
    return between(middle + random_direction(random) * 6, middle + out * random.between(0.7, 0.9));
  }
};

// Behind the hit of the whole ray the field rises by at least the distance (by n - 1 over a radius where a ray meets
// the surface at a right angle). Now and then the end of a ray, as a float of its cell, lies behind the end.
TEST(Occlusion, ARayThatEndsInsideIsHidden) {
  Random random(83);
  int ends = 0;
  for (int scene = 0; scene < 8; ++scene) {
    const BallsOnBalls balls(random);
    const auto tracer = std::move(*BlendTracer::make(balls.blend, {}));
    for (int i = 0; i < 2000; ++i) {
      const Ray ray = balls.ray(random);
      const auto hit = first_hit(*tracer, ray);
      if (!hit) continue;
      EXPECT_FALSE(is_hidden(*tracer, ray, *hit - 1e-5));
      const double there = corrected_value(balls.blend, ray.at(*hit));
      for (const double behind : {5e-6, 1e-5, 2e-5}) {
        if (!(corrected_value(balls.blend, ray.at(*hit + behind)) > there + behind)) continue;
        EXPECT_TRUE(is_hidden(*tracer, ray, *hit + behind)) << "scene " << scene << ", ray " << i << ", " << behind;
        ++ends;
      }
    }
  }
  EXPECT_GT(ends, 10'000);
}

}  // namespace
}  // namespace marrow::test
