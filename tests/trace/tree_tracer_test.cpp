// The tracer of general trees against dense sampling of the field along rays, over random trees of all kinds of nodes.
#include "field/trace/general/tree_tracer.h"

#include <algorithm>
#include <iostream>
#include <utility>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "field/program/field_program.h"
#include "field/trace/general/crossing.h"
#include "field/tree/any_node.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

FieldNodeId ball(FieldDescription& field, Random& random) {
  Sphere s;
  s.center = random.vector(1.2);
  s.radius = random.between(0.2, 0.9);
  s.potential = WyvillProfile{random.between(0.2, 1.5)};
  return field.add({.what = GeneralNode{.node = boxed(s), .of = {}, .material = {}}, .where = {}});
}

Primitive tube(Random& random) {
  Primitive one;
  one.skeleton = random.segment();
  return one;
}

FieldNodeId tubes(FieldDescription& field, Random& random) {
  Blend blend;
  for (int i = random.whole(1, 3); i > 0; --i) blend.of.push_back(field.add({.what = tube(random), .where = {}}));
  if (random.between(0, 1) < 0.3) blend.alpha = random.between(0, 1.5);
  if (random.between(0, 1) < 0.3) blend.projection = Projection::Exact;
  return field.add({.what = std::move(blend), .where = {}});
}

FieldNodeId leaf(FieldDescription& field, Random& random) {
  return random.between(0, 1) < 0.7 ? ball(field, random) : tubes(field, random);
}

FieldNodeId combined(FieldDescription& field, Random& random, std::vector<FieldNodeId> of) {
  const auto general = [&](AnyNode node) {
    return field.add(
        {.what = GeneralNode{.node = boxed(std::move(node)), .of = std::move(of), .material = {}}, .where = {}});
  };
  switch (random.whole(0, 4)) {
    case 0:
      return general(Intersection{});
    case 1:
      return general(Difference{});
    case 2:
      return general(Ricci{random.between(1, 9)});
    case 3: {
      const FieldNodeId inner = field.add({.what = Union{of}, .where = {}});
      Twist twist;
      twist.angle_per_length = random.between(-1.5, 1.5);
      return field.add({.what = GeneralNode{.node = boxed(twist), .of = {inner}, .material = {}}, .where = {}});
    }
    default:
      return field.add({.what = Union{std::move(of)}, .where = {}});
  }
}

FieldTree random_tree(Random& random) {
  FieldDescription field;
  std::vector<FieldNodeId> layer;
  for (int i = random.whole(2, 5); i > 0; --i) layer.push_back(leaf(field, random));
  while (layer.size() > 1) {
    const FieldNodeId a = layer.back();
    layer.pop_back();
    const FieldNodeId b = layer.back();
    layer.pop_back();
    layer.insert(layer.begin(), combined(field, random, {b, a}));
  }
  const Affine map = Affine::rotate(normalize(random.vector(1)), random.between(0, 3)) *
                     Affine::scale({random.between(0.6, 1.4), random.between(0.6, 1.4), 1});
  // A Ricci blend of one keeps the root a general node.
  const FieldNodeId placed = field.add({.what = Transform{map, layer[0]}, .where = {}});
  field.root = field.add({.what = GeneralNode{.node = boxed(Ricci{1}), .of = {placed}, .material = {}}, .where = {}});
  const auto program = compile(field);
  EXPECT_TRUE(program) << program.why()[0].message;
  EXPECT_EQ(program->trees().size(), 1u);
  return program->trees()[0];
}

// All cells by themselves, without a hierarchy.
CrossingSearch traced(const TreeTracer& tracer, const Ray& ray) {
  CrossingSearch first;
  for (std::size_t cell = 0; cell < tracer.cell_count(); ++cell) {
    CellLog log;
    const auto hit = tracer.first_hit(cell, ray, false, log);
    first.undecided = std::min(first.undecided, log.undecided);
    first.evaluations += log.evaluations;
    if (hit && (!first.t || hit->t < *first.t)) first.t = hit->t;
  }
  return first;
}

bool is_any(const TreeTracer& tracer, const Ray& ray) {
  for (std::size_t cell = 0; cell < tracer.cell_count(); ++cell) {
    CellLog log;
    if (tracer.first_hit(cell, ray, true, log)) return true;
  }
  return false;
}

// The first change of side among samples, as an interval.
std::optional<Interval> sampled(const FieldTree& tree, const Ray& ray, double end) {
  constexpr int samples = 3000;
  bool inside = value(tree, ray.origin) >= 1;
  for (int i = 1; i <= samples; ++i) {
    const double t = end * i / samples;
    if ((value(tree, ray.at(t)) >= 1) != inside) return Interval{end * (i - 1) / samples, t};
  }
  return {};
}

TEST(TreeTracer, NeverComesAfterWhatSamplingFindsAndAlwaysLiesOnTheSurface) {
  Random random(41);
  int hits = 0, undecided = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const FieldTree tree = random_tree(random);
    const auto tracer = TreeTracer::make(tree);
    ASSERT_TRUE(tracer) << tracer.why()[0].message;
    for (int r = 0; r < 12; ++r) {
      const Vec3d from = normalize(random.vector(1)) * 8.0;
      const Ray ray{.origin = from, .direction = normalize(random.vector(1.2) - from)};
      const CrossingSearch found = traced(*tracer, ray);
      const auto expected = sampled(tree, ray, 16);
      undecided += found.undecided < 1e300;
      if (expected) {
        ASSERT_TRUE(found.t) << "scene " << scene << " ray " << r << " missed at " << expected->lo;
        EXPECT_LE(*found.t, expected->hi + 1e-9) << "scene " << scene << " ray " << r;
      }
      if (!found.t) continue;
      ++hits;
      const double before = value(tree, ray.at(*found.t - 1e-9)), after = value(tree, ray.at(*found.t + 1e-9));
      EXPECT_NE(before >= 1, after >= 1) << "scene " << scene << " ray " << r << ": " << before << " " << after;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_LE(undecided, 5);
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
  const FieldNodeId blend = field.add({.what = std::move(alone), .where = {}});
  // A Ricci blend of one keeps the root a general node.
  field.root = field.add({.what = GeneralNode{.node = boxed(Ricci{1}), .of = {blend}, .material = {}}, .where = {}});
  return compile(field)->trees()[0];
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

// A bend cuts space behind the centre of its circle: rays across the cut are decided all the same.
TEST(TreeTracer, DecidesRaysAcrossACut) {
  Random random(43);
  int hits = 0, rays = 0;
  for (int scene = 0; scene < 12; ++scene) {
    FieldDescription field;
    const FieldNodeId bar =
        field.add({.what = GeneralNode{.node = boxed(Box{.size = {0.5, 3, 0.5}, .rounding = 0.05, .potential = {}}),
                                       .of = {},
                                       .material = {}},
                   .where = {}});
    const Bend bend{.length = random.between(1, 3), .angle = random.between(1, 6)};
    field.root = field.add({.what = GeneralNode{.node = boxed(bend), .of = {bar}, .material = {}}, .where = {}});
    const auto program = compile(field);
    ASSERT_TRUE(program) << program.why()[0].message;
    const auto tracer = TreeTracer::make(program->trees()[0]);
    ASSERT_TRUE(tracer) << tracer.why()[0].message;
    const double radius = bend.length / bend.angle;
    for (int i = 0; i < 100; ++i, ++rays) {
      const Vec3d from = normalize(random.vector(1)) * 8.0;
      const Vec3d behind{radius + random.between(0, 2), random.between(-0.1, 0.1), random.between(-0.3, 0.3)};
      const Ray ray{.origin = from, .direction = normalize(behind - from)};
      const CrossingSearch found = traced(*tracer, ray);
      EXPECT_GT(found.undecided, 1e300) << "scene " << scene << " ray " << i;
      const auto expected = sampled(program->trees()[0], ray, 16);
      if (expected) { EXPECT_TRUE(found.t && *found.t <= expected->hi + 1e-9) << "scene " << scene << " ray " << i; }
      hits += found.t.has_value();
    }
  }
  EXPECT_GT(hits, rays / 20);
  EXPECT_LT(hits, rays);
}

FieldNodeId add(FieldDescription& field, AnyNode node, std::vector<FieldNodeId> of = {}) {
  return field.add(
      {.what = GeneralNode{.node = boxed(std::move(node)), .of = std::move(of), .material = {}}, .where = {}});
}

TreeTracer tracer_of(const FieldDescription& field) {
  const auto program = compile(field);
  EXPECT_TRUE(program) << program.why()[0].message;
  auto tracer = TreeTracer::make(program->trees()[0]);
  EXPECT_TRUE(tracer) << tracer.why()[0].message;
  return std::move(*tracer);
}

// Two boxes with a face in common, or a hair between them: from inside one leaves only where there is an outside. Far
// from the origin places are rounded by more than sums are, and where fields are flat sums by more than places.
TEST(TreeTracer, GoesThroughACommonFaceButNotAcrossAGap) {
  Random random(44);
  for (const auto& [away, range] : {std::pair{0.0, 1.0}, {4.7e4, 1.0}, {0.0, 1e4}})
    for (const double gap : {0.0, 1e-16, 1e-6}) {
      FieldDescription field;
      const auto box = [&](double center, double size) {
        return add(field,
                   Box{.center = {away + center, 0, 0}, .size = {size, 2, 2}, .potential = WyvillProfile{range}});
      };
      field.root = field.add({.what = Union{{box(0, 2), box(1.75 + gap, 1.5)}}, .where = {}});
      const TreeTracer tracer = tracer_of(field);
      for (int i = 0; i < 60; ++i) {
        const Vec3d from{away + 0.3, random.between(-0.9, 0.9), random.between(-0.9, 0.9)};
        const Vec3d to{away + 2.4, random.between(-0.9, 0.9), random.between(-0.9, 0.9)};
        const Ray ray{.origin = from, .direction = normalize(to - from)};
        const CrossingSearch found = traced(tracer, ray);
        ASSERT_TRUE(found.t) << "gap " << gap;
        const double x = ray.at(*found.t).x - away;
        if (gap > 1e-15) EXPECT_NEAR(x, 1, 1e-12 + 1e-14 * away);
        else EXPECT_GT(x, 2.3) << "away " << away << " range " << range;
      }
    }
}

// However many sizes away a ray begins, what it meets is as thin as where it stands tells.
TEST(TreeTracer, FindsThinBodiesFromFarAway) {
  Random random(45);
  for (const double radius : {1e-4, 1e-6, 1e-8}) {
    FieldDescription field;
    field.root = add(field, Ricci{1}, {add(field, Sphere{.center = {}, .radius = radius, .potential = {}})});
    const TreeTracer tracer = tracer_of(field);
    for (int i = 0; i < 30; ++i) {
      const UnitVec3 direction = normalize(random.vector(1));
      const CrossingSearch found = traced(tracer, {.origin = direction * -1e5, .direction = direction});
      ASSERT_TRUE(found.t) << "radius " << radius;
      EXPECT_NEAR(*found.t, 1e5 - radius, 1e-9);
      EXPECT_GT(found.undecided, 1e300);
    }
  }
}

// A ray in the plane of one cut meets another one at their edge: that plane is on the surface, and starts lie beside
// it.
TEST(TreeTracer, StartsBesideAPlaneThatTheRayRunsIn) {
  FieldDescription field;
  const FieldNodeId ball = add(field, Sphere{.center = {}, .radius = 0.9, .potential = {}});
  const FieldNodeId corner = add(field, Box{.center = {0.5, 0.5, 0}, .size = {1, 1, 3}, .potential = {}});
  field.root = add(field, Difference{}, {ball, corner});
  const TreeTracer tracer = tracer_of(field);
  Random random(46);
  int hits = 0;
  for (int i = 0; i < 40; ++i) {
    const Vec3d from{random.between(1, 3), 0, random.between(-1, 1)}, to{0, 0, random.between(-0.5, 0.5)};
    const Ray ray{.origin = from, .direction = normalize(to - from)};
    for (std::size_t cell = 0; cell < tracer.cell_count(); ++cell) {
      CellLog log;
      const auto hit = tracer.first_hit(cell, ray, false, log);
      if (!hit) continue;
      ++hits;
      EXPECT_LT(value(tracer.tree(), tracer.surface_at(cell, ray.at(hit->t), ray.direction).outside), 1);
    }
  }
  EXPECT_GT(hits, 20);
}

TEST(TreeTracer, SpawnedPointsLieOutside) {
  Random random(43);
  int hits = 0;
  for (int scene = 0; scene < 20; ++scene) {
    const FieldTree tree = random_tree(random);
    const auto tracer = TreeTracer::make(tree);
    ASSERT_TRUE(tracer);
    for (int r = 0; r < 60 && tracer->cell_count() > 0; ++r) {
      const auto cell = static_cast<std::size_t>(random.whole(0, static_cast<int>(tracer->cell_count()) - 1));
      const Box3 box = tracer->cell_box(cell);
      const Vec3d from = normalize(random.vector(1)) * 8.0;
      const Vec3d to = box.center() + random.vector(0.3 * max_component(box.size()));
      const Ray ray{.origin = from, .direction = normalize(to - from)};
      CellLog log;
      const auto hit = tracer->first_hit(cell, ray, false, log);
      if (!hit) continue;
      ++hits;
      const SurfacePoint at = tracer->surface_at(cell, ray.at(hit->t));
      EXPECT_LT(value(tree, at.outside), 1);
      EXPECT_LT(length(at.outside - ray.at(hit->t)), 0.01);
    }
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace marrow
