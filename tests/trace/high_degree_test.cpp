// Fields of high degree fall so fast that what is little in radii is much in the field: hits are judged by the field.
#include <algorithm>
#include <cmath>
#include <iostream>

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

// Of hits that do not graze.
double largest_excess(const BlendField& blend, int rays, Random& random, int& hits) {
  const auto tracer = std::move(*BlendTracer::make(blend, {}));
  double largest = 0;
  for (int i = 0; i < rays; ++i) {
    const Vec3d eye = random_direction(random) * 4.0;
    const Ray ray{eye, normalize(random.vector(0.6) - eye)};
    const auto t = first_hit(*tracer, ray);
    if (!t) continue;
    const BlendSample exact = evaluate(blend, ray.at(*t));
    if (!(dot(exact.corrected_gradient, ray.direction) > 0.1 * length(exact.corrected_gradient))) continue;
    ++hits;
    largest = std::max(largest, std::fabs(exact.corrected - 1));
  }
  return largest;
}

// The last step to the root took as long a way as at degree 4: C was off by up to 1e-4.
TEST(HighDegrees, HitsLieOnTheSurface) {
  Random random(2026112901);
  int hits = 0;
  double largest = 0;
  for (const int degree : {11, 14, 17, 20})
    for (int scene = 0; scene < 4; ++scene)
      largest = std::max(largest, largest_excess(crowded_points(random, degree), 1000, random, hits));
  std::cout << "  " << hits << " hits; the field there is off 1 by " << largest << '\n';
  EXPECT_GT(hits, 5000);
  EXPECT_LT(largest, 1e-5);
}

// And it began at a sample that had not asked for the angle of its place.
TEST(HighDegrees, HitsLieOnTheSurfaceWhereEachSkeletonHasItsAngle) {
  Random random(2026112902);
  int hits = 0;
  double largest = 0;
  for (const int degree : {8, 13, 20})
    for (int scene = 0; scene < 2; ++scene)
      largest = std::max(largest, largest_excess(nearly_parallel_segments(random, degree), 2000, random, hits));
  std::cout << "  " << hits << " hits; the field there is off 1 by " << largest << '\n';
  EXPECT_GT(hits, 500);
  EXPECT_LT(largest, 1e-5);
}

}  // namespace
}  // namespace marrow::test
