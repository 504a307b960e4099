// Fields of high degree fall so fast that what is little in radii is much in the field: hits are judged by the field.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iostream>
#include <utility>

#include <gtest/gtest.h>

#include "field/blend/blend_field.h"
#include "tests/trace/first_of_tiles.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

BlendField crowded_points(Random& random, int degree) {
  BlendField blend;
  blend.degree = degree;
  blend.alpha = random.between(0.5, 1.4);
  for (int i = 0; i < 25; ++i) blend.points.add({random.vector(0.6), i % 3 == 0 ? 0.05 : random.between(0.2, 0.3)}, {});
  return blend;
}

// Two segments that nearly coincide, each with its own angle.
BlendField nearly_parallel_segments(Random& random, int degree) {
  BlendField blend;
  blend.degree = degree;
  blend.alpha_per_skeleton = true;
  const Vec3d from = random.vector(1), to = from + random_direction(random) * 1.8;
  blend.segments.add({from, to, 0.3, 0.2}, {});
  blend.segments.add({from + random.vector(1e-3), to + random.vector(1e-3), 0.3, 0.3}, {});
  blend.segments.alphas = {-0.8, 1.0};
  return blend;
}

// The largest |C - 1| at hits that do not graze, of so many scenes of each degree.
double largest_excess(BlendField (*draw)(Random&, int), std::initializer_list<int> degrees, int scenes, int& hits) {
  Random random(20261129);
  double largest = 0;
  for (const int degree : degrees)
    for (int scene = 0; scene < scenes; ++scene) {
      const BlendField blend = draw(random, degree);
      const auto tracer = std::move(*BlendTracer::make(blend, {}));
      for (int i = 0; i < 1000; ++i) {
        const Vec3d eye = random_direction(random) * 4.0;
        const Ray ray{eye, normalize(random.vector(0.6) - eye)};
        const auto t = first_hit(*tracer, ray);
        if (!t) continue;
        const BlendSample exact = evaluate(blend, ray.at(*t));
        if (!(dot(exact.corrected_gradient, ray.direction) > 0.1 * length(exact.corrected_gradient))) continue;
        ++hits;
        largest = std::max(largest, std::fabs(exact.corrected - 1));
      }
    }
  std::cout << "  " << hits << " hits; the field there is off 1 by " << largest << '\n';
  return largest;
}

// The last step to the root took as long a way as at degree 4: C was off by up to 1e-4.
TEST(HighDegrees, HitsLieOnTheSurface) {
  int hits = 0;
  EXPECT_LT(largest_excess(crowded_points, {11, 14, 17, 20}, 4, hits), 1e-5);
  EXPECT_GT(hits, 5000);
}

// And it began at a sample that had not asked for the angle of its place.
TEST(HighDegrees, HitsLieOnTheSurfaceWhereEachSkeletonHasItsAngle) {
  int hits = 0;
  EXPECT_LT(largest_excess(nearly_parallel_segments, {8, 13, 20}, 4, hits), 1e-5);
  EXPECT_GT(hits, 500);
}

}  // namespace
}  // namespace marrow::test
