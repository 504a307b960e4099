// Rays that graze bodies: touches of silhouettes, and ways along a tube just above or below its surface.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <utility>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "tests/trace/traced_trees.h"

namespace marrow::test {
namespace {

bool is_any(const TreeTracer& tracer, const Ray& ray) {
  for (std::size_t cell = 0; cell < tracer.cell_count(); ++cell) {
    CellLog log;
    if (tracer.first_hit(cell, ray, true, log)) return true;
  }
  return false;
}

// Silhouettes, between a ray that hits and one that does not, with ends at any distance behind the touch.
TEST(TreeTracer, TellsATouchBeforeAnyEndOfTheRay) {
  Random random(78);
  int touches = 0, missed = 0;
  for (int scene = 0; scene < 20; ++scene) {
    const auto tracer = TreeTracer::make(random_tree(random));
    ASSERT_TRUE(tracer) << tracer.why()[0].message;
    for (int i = 0; i < 20; ++i) {
      const Vec3d eye = normalize(random.vector(1)) * 6;
      const auto ray_to = [&](const Vec3d& aim) {
        return Ray{.origin = eye, .direction = normalize(aim - eye), .t_min = 0, .t_max = 20};
      };
      Vec3d hits = random.vector(1.2), misses = random.vector(3);
      if (!traced(*tracer, ray_to(hits)).t || traced(*tracer, ray_to(misses)).t) continue;
      for (int step = 0; step < 40; ++step) {
        const Vec3d aim = (hits + misses) * 0.5;
        (traced(*tracer, ray_to(aim)).t ? hits : misses) = aim;
      }
      Ray ray = ray_to(hits);
      const CrossingSearch touch = traced(*tracer, ray);
      if (touch.undecided < *touch.t) continue;
      ++touches;
      bool is_told = true;
      for (int k = 0; k < 10; ++k) {
        ray.t_max = *touch.t + pow(10.0, random.between(-5, 0.5));
        is_told = is_told && is_any(*tracer, ray);
      }
      missed += !is_told;
    }
  }
  std::cout << "  " << touches << " touches, " << missed << " of them missed\n";
  EXPECT_GT(touches, 40);
  EXPECT_EQ(missed, 0);
}

FieldTree compact_tube(const Vec3d& end, double radius, const Kernel& kernel) {
  FieldDescription field;
  Primitive one;
  one.skeleton = SegmentSkeleton{-end, end, radius, radius};
  const FieldNodeId tube = field.add({.what = one, .where = {}});
  Blend alone;
  alone.kernel = kernel;
  alone.of = {tube};
  return tree_above(field, field.add({.what = std::move(alone), .where = {}}));
}

// Along a tube under the compact kernel nothing changes but at its ends, whatever way the tube goes: rays beside it or
// just below its surface are decided at once.
TEST(TreeTracer, DecidesRaysAlongACompactTube) {
  Random random(79);
  std::uint32_t most = 0;
  int hits = 0, undecided = 0, wrong = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3d along = normalize(i % 3 == 0 ? Vec3d{1, 0, 0} : random.vector(1)).vec();
    const Vec3d across = normalize(cross(along, random.vector(1))).vec();
    const double radius = random.between(0.05, 0.3);
    const FieldTree blend = compact_tube(along * 2, radius, {KernelFamily::Compact, random.whole(4, 9), 2});
    double inside = 0, outside = 3 * radius;
    for (int step = 0; step < 100; ++step)
      (value(blend, across * (0.5 * (inside + outside))) >= 1 ? inside : outside) = 0.5 * (inside + outside);
    const auto tracer = TreeTracer::make(blend);
    ASSERT_TRUE(tracer) << tracer.why()[0].message;
    const double beyond = pow(10, random.between(-8, -3)) * (i % 2 == 0 ? 1 : -1);
    const Ray ray{
        .origin = across * (inside * (1 + beyond)) - along * 5, .direction = normalize(along), .t_min = 0, .t_max = 10};
    const CrossingSearch found = traced(*tracer, ray);
    most = std::max(most, found.evaluations);
    hits += found.t.has_value();
    wrong += found.t.has_value() != (beyond < 0);
    undecided += found.undecided < Box3::inf;
  }
  std::cout << "  " << hits << " hits, " << wrong << " wrong, " << undecided << " undecided, evaluations " << most
            << '\n';
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(undecided, 0);
  EXPECT_LT(most, 1000u);
}

}  // namespace
}  // namespace marrow::test
