// Segments much shorter than their radius: their gradient is large against their field, and tables near the plain sum
// have to hold as far. Where they were level beyond 6 (n - 1) C was off by up to 0.06, and rays beside the surface met
// it.
#include <algorithm>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "field/trace/curve/largest_gradient.h"
#include "tests/trace/first_of_tiles.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {
namespace {

BlendField short_segment(int degree, double part) {
  BlendField field;
  field.degree = degree;
  field.segments.add({{0, 0, 0}, {part, 0, 0}, 1, 1}, {});
  return field;
}

// Of rays from all sides, at the origin.
void expect_hits_on_surface(const BlendField& field, int rays, Random& random) {
  const auto tracer = std::move(*BlendTracer::make(field, {}));
  int hits = 0;
  for (int i = 0; i < rays; ++i) {
    const Vec3d eye = random_direction(random) * 3.0;
    const Ray ray{eye, normalize(random.vector(0.02) - eye)};
    const auto t = first_hit(*tracer, ray);
    if (!t) continue;
    ++hits;
    EXPECT_NEAR(corrected_value(field, ray.at(*t)), 1, 1e-5);
  }
  EXPECT_GT(hits, rays / 2);
}

TEST(ShortSkeletons, AreMetOnTheirSurface) {
  Random random(304);
  for (const int n : {3, 4, 6})
    for (const double alpha : {1.45, 1.5, 1.54, 1.56, 1.57})
      for (const double part : {1e-2, 1e-3, 1e-5}) {
        SCOPED_TRACE(testing::Message() << "n=" << n << " alpha=" << alpha << " length " << part);
        BlendField field = short_segment(n, part);
        field.alpha = alpha;
        expect_hits_on_surface(field, 40, random);
      }
}

TEST(ShortSkeletons, AreMetOnTheirSurfaceWithAnglesOfTheirOwn) {
  Random random(306);
  for (const int n : {3, 4})
    for (const auto& [own, other] : {std::pair{1.5, 1.2}, {1.54, 1.5}, {1.56, 1.2}, {1.57, 1.54}})
      for (const double part : {1e-3, 1e-4}) {
        SCOPED_TRACE(testing::Message() << "n=" << n << " alpha=" << own << ", " << other << " length " << part);
        BlendField field = short_segment(n, part);
        field.alpha_per_skeleton = true;
        field.segments.add({{0, 0, 9}, {1, 0, 9}, 0.1, 0.1}, {});
        field.segments.alphas = {own, other};
        expect_hits_on_surface(field, 20, random);
      }
}

TEST(ShortSkeletons, HaveBoundsOfTheGradientAtTheirSurface) {
  Random random(305);
  double most = 0;
  for (int i = 0; i < 300; ++i) {
    BlendField field;
    field.degree = random.whole(3, 8);
    const double radius = random.between(0.5, 2), part = radius * exp(random.between(-14, 0));
    field.segments.add({{0, 0, 0}, {part, 0, 0}, radius, radius}, {});
    // The plain sum is 1 where the surface is.
    const Vec3d direction = random_direction(random);
    double low = 0, high = 4 * radius;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (corrected_value(field, direction * middle) > 1 ? low : high) = middle;
    }
    const double found = evaluate(field, direction * high).si_norm, bound = largest_gradient(field);
    EXPECT_LE(found, bound * (1 + 1e-9)) << "degree " << field.degree << " length " << part;
    most = std::max(most, found / bound);
  }
  EXPECT_GT(most, 0.9);
}

}  // namespace
}  // namespace marrow::test
