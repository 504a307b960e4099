// Rays that begin inside: the first hit is where they leave, and occluded rays agree.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "field/trace/blend_tracer.h"
#include "tests/trace/first_of_tiles.h"
#include "tests/trace/large_cells.h"
#include "tests/trace/oracle.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

// In a skeleton, or anywhere clearly inside.
std::optional<Vec3d> place_inside(Random& random, const BlendField& field, const Oracle& oracle) {
  const auto& segments = field.segments.skeletons;
  const SegmentSkeleton& s = segments[static_cast<std::size_t>(random.whole(0, static_cast<int>(segments.size()) - 1))];
  const Vec3d on_axis = lerp(s.from, s.to, random.between(0.1, 0.9));
  const Vec3d p = random.between(0, 1) < 0.3 ? on_axis : on_axis + random.vector(1.2 * s.radius_from);
  return oracle.value(p) > 1.001 ? std::optional(p) : std::nullopt;
}

void expect_inside_until(const Oracle& oracle, const Ray& ray, double t) {
  constexpr int samples = 64;
  for (int i = 1; i < samples; ++i) {
    const double at = t * i / samples, value = oracle.value(ray.at(at));
    ASSERT_TRUE(!(value < 1 - 1e-5)) << "outside at t = " << at << ", which is before the exit at " << t;
  }
}

TEST(RayFromInside, LeavesWhereTheFieldFallsToOne) {
  Random random(77);
  int rays = 0;
  for (const int n : {3, 4, 6})
    for (const double alpha : {-0.4, 0.0, contact_alpha(n), std::numbers::pi / 2}) {
      const BlendField field = random_scene(random, {n, alpha}, random.whole(2, 7));
      const Oracle oracle(field);
      const auto made = BlendTracer::make(field, {});
      ASSERT_TRUE(made);
      const BlendTracer& tracer = **made;
      for (int i = 0; i < 60; ++i) {
        const auto from = place_inside(random, field, oracle);
        if (!from) continue;
        Ray ray{*from, UnitVec3::unchecked(random_direction(random))};
        const auto exit = first_hit(tracer, ray, false);
        ASSERT_TRUE(exit) << "n " << n << " alpha " << alpha;
        ++rays;
        EXPECT_NEAR(oracle.value(ray.at(*exit)), 1, 1e-5) << "n " << n << " alpha " << alpha;
        expect_inside_until(oracle, ray, *exit);
        ray.t_max = *exit * 1.001;
        EXPECT_TRUE(first_hit(tracer, ray, true));
        if (HasFatalFailure()) return;
      }
    }
  EXPECT_GT(rays, 300);
  std::cout << "  " << rays << " rays\n";
}

// Between parallel hairs that touch, or nearly so, the scaled field bends and the curve has its kink: the last estimate
// of a root was accepted up to a whole gap beside it, where the field was off by up to 1.7e-4.
TEST(RayFromInside, LeavesAtNecksAsExactlyAsElsewhere) {
  Random random(83);
  int exits = 0;
  double farthest = 0;
  for (const int n : {4, 6, 8, 10, 12})
    for (const double gap : {0.196, 0.2, 0.20112, 0.204}) {
      BlendField field;
      field.degree = n;
      field.alpha = contact_alpha(n);
      const Vec3d axes[] = {{0, 0, 0}, {0, 0, gap}, {gap, 0, gap}};
      for (const Vec3d& a : axes) field.segments.add({a - Vec3d{0, 0.7, 0}, a + Vec3d{0, 0.7, 0}, 0.1, 0.1}, {});
      const auto made = BlendTracer::make(field, {});
      ASSERT_TRUE(made);
      for (int i = 0; i < 150; ++i) {
        const Vec3d along{0, random.between(-0.6, 0.6), 0};
        const Vec3d from = axes[random.whole(0, 2)] + along + random.vector(0.02);
        const Vec3d neck = 0.5 * (axes[i % 2] + axes[i % 2 + 1]) + along + random.vector(0.05);
        const Ray ray{from, normalize(neck - from)};
        const auto exit = first_hit(**made, ray, false);
        ASSERT_TRUE(exit) << "n " << n;
        const BlendSample at = evaluate(field, ray.at(*exit));
        if (std::fabs(dot(at.corrected_gradient, ray.direction)) < 0.3 * length(at.corrected_gradient)) continue;
        ++exits;
        farthest = std::max(farthest, std::fabs(at.corrected - 1));
      }
    }
  std::cout << "  " << exits << " exits, the field off 1 by " << farthest << " at most\n";
  EXPECT_GT(exits, 2000);
  EXPECT_LT(farthest, 5e-6);
}

// The body of a short segment is far smaller than its radius, and so than the cells around it.
TEST(RayFromInside, LeavesBodiesMuchSmallerThanTheirRadius) {
  Random random(79);
  TraceOptions options = large_cells();
  options.cells = {.cell_size = 1.6, .tile_levels = 2};
  for (const int n : {3, 4, 8})
    for (const double length : {1e-3, 1e-5, 1e-7}) {
      BlendField field;
      field.degree = n;
      field.alpha = 1e-9;
      field.segments.add({{0.3, 0.2, 0.1}, Vec3d{0.3, 0.2, 0.1} + random_direction(random) * (length * 0.1), 0.1, 0.1},
                         {});
      field.points.add({{2, 0, 0}, 0.1}, {});
      const Oracle oracle(field);
      const auto made = BlendTracer::make(field, options);
      ASSERT_TRUE(made);
      for (int i = 0; i < 100; ++i) {
        const Ray ray{field.segments.skeletons[0].from, UnitVec3::unchecked(random_direction(random))};
        const auto exit = first_hit(**made, ray, false);
        ASSERT_TRUE(exit) << "n " << n;
        EXPECT_NEAR(oracle.value(ray.at(*exit)), 1, 1e-4) << "n " << n << " length " << length;
      }
    }
}

// On a source sums overflow, although of so short a segment they are not as large as floats get. What is left of the
// body there is some 1e-3 radii: places in float tell its surface to a thousandth.
TEST(RayFromInside, LeavesSegmentsOfAFewRoundings) {
  Random random(80);
  for (const int n : {5, 6, 8, 12})
    for (const double length : {1e-11, 1e-12, 1e-13, 1e-14}) {
      BlendField field;
      field.degree = n;
      field.alpha = contact_alpha(n);
      const Vec3d from{0.95, 0.87, -0.76};
      field.segments.add({from, from + random_direction(random) * (length * 0.15), 0.15, 0.15}, {});
      field.segments.add({{0.37, 0.09, 0.46}, {0.36, 0.1, 0.45}, 0.07, 0.07}, {});
      const Oracle oracle(field);
      const auto made = BlendTracer::make(field, {});
      ASSERT_TRUE(made);
      for (int i = 0; i < 100; ++i) {
        const Ray ray{from, UnitVec3::unchecked(random_direction(random))};
        const auto exit = first_hit(**made, ray, false);
        ASSERT_TRUE(exit) << "n " << n;
        EXPECT_NEAR(oracle.value(ray.at(*exit)), 1, 1e-3 * n) << "n " << n << " length " << length;
      }
    }
}

// Deeper than sums are off, however little: not through the body, and not met at its beginning.
TEST(RayFromInside, BeginsJustBelowTheSurface) {
  Random random(78);
  constexpr double radius = 0.3;
  for (const int n : {3, 4, 8, 12}) {
    BlendField field;
    field.degree = n;
    field.alpha = std::numbers::pi / 2;
    field.points.add({{0.1, 0.2, -0.1}, radius}, {});
    const auto made = BlendTracer::make(field, {});
    ASSERT_TRUE(made);
    for (int i = 0; i < 400; ++i) {
      const Vec3d out = random_direction(random), in = random_direction(random);
      const double depth = random.between(1.1e-5, 4e-5) * radius / (n - 1);
      const Ray ray{field.points.skeletons[0].at + out * (radius - depth),
                    UnitVec3::unchecked(dot(in, out) < 0 ? in : -in)};
      const double through = -2 * radius * dot(ray.direction.vec(), out);
      if (through < 0.1 * radius) continue;
      const auto exit = first_hit(**made, ray, false);
      ASSERT_TRUE(exit) << "n " << n;
      EXPECT_NEAR(*exit, through, 1e-3 * radius) << "n " << n;
    }
  }
}

}  // namespace
}  // namespace marrow::test
