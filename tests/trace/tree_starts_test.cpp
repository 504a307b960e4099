// Where further rays start beside the surface of a general tree.
#include <cstddef>

#include <gtest/gtest.h>

#include "field/math/affine.h"
#include "tests/trace/traced_trees.h"

namespace marrow::test {
namespace {

// A ray in the plane of one cut meets another one at their edge: that plane is on the surface, and starts lie beside
// it.
TEST(TreeStarts, LieBesideAPlaneThatTheRayRunsIn) {
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

// Down the face of one box to the edge of another that goes on in its plane: outside is behind the ray and aside,
// nowhere else, and by rounding either box may be met.
TEST(TreeStarts, LieInACornerToWhichTheRayRunsInAFace) {
  Random random(49);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    FieldDescription field;
    const FieldNodeId wide = add(field, Box{.center = {}, .size = {2, 1, 1.2}, .potential = {}});
    const FieldNodeId beside = add(field, Box{.center = {1.5, 0.25, 0}, .size = {1, 1, 1.2}, .potential = {}});
    const FieldNodeId both = field.add({.what = Union{{wide, beside}}, .where = {}});
    const double scale = random.between(0.03, 3);
    const Affine map = Affine::scale({scale, scale, scale});
    const FieldTree tree = tree_above(field, field.add({.what = Transform{map, both}, .where = {}}));
    const auto tracer = TreeTracer::make(tree);
    ASSERT_TRUE(tracer) << tracer.why()[0].message;
    const Ray ray{.origin = {scale, random.between(1, 7) * scale, 0}, .direction = UnitVec3::unchecked({0, -1, 0})};
    for (std::size_t cell = 0; cell < tracer->cell_count(); ++cell) {
      CellLog log;
      const auto hit = tracer->first_hit(cell, ray, false, log);
      if (!hit) continue;
      ++hits;
      const SurfacePoint at = tracer->surface_at(cell, ray.at(hit->t), ray.direction);
      EXPECT_LT(value(tree, at.outside), 1) << "scale " << scale << " at " << ray.at(hit->t).y / scale;
      EXPECT_GE(dot(at.normal, at.outside - ray.at(hit->t)), 0);
    }
  }
  EXPECT_GT(hits, 20);
}

TEST(TreeStarts, LieOutside) {
  Random random(43);
  int hits = 0;
  for (int scene = 0; scene < 40; ++scene) {
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

FieldNodeId tube_of(FieldDescription& field, const SegmentSkeleton& skeleton) {
  Primitive one;
  one.skeleton = skeleton;
  Blend blend;
  blend.of.push_back(field.add({.what = one, .where = {}}));
  return field.add({.what = std::move(blend), .where = {}});
}

// Both fields are infinite there: deep inside, whatever is infinite less infinite.
TEST(TreeStarts, AtANodeOfTwoBodiesInContactAreInside) {
  FieldDescription field;
  const FieldNodeId one = tube_of(field, {{0, 0, 0}, {-1, 0, 0}, 0.3, 0.3});
  const FieldNodeId other = tube_of(field, {{-1, 0, 0}, {-1, 1, 0}, 0.3, 0.3});
  field.root = add(field, Contact{}, {one, other});
  const TreeTracer tracer = tracer_of(field);
  Random random(50);
  for (int i = 0; i < 200; ++i) {
    const Vec3d toward = i == 0 ? Vec3d{-1, 0, 0} : i == 1 ? Vec3d{0, 0, 1} : random.vector(1);
    const Ray ray{.origin = {-1, 0, 0}, .direction = normalize(toward)};
    const CrossingSearch found = traced(tracer, ray);
    ASSERT_TRUE(found.t) << "ray " << i;
    EXPECT_GT(*found.t, 0.1);
    EXPECT_NEAR(value(tracer.tree(), ray.at(*found.t)), 1, 1e-6) << "ray " << i;
    for (double t = 1e-9; t < *found.t; t *= 1.1) ASSERT_GE(value(tracer.tree(), ray.at(t)), 1) << "ray " << i;
  }
}

// Along the axis of a tube in the plane of a plate: infinite all along, yet certainly inside.
TEST(TreeStarts, AlongTwoSkeletonsInContactTakeFewEvaluations) {
  FieldDescription field;
  const FieldNodeId one = tube_of(field, {{-1, 0, 0}, {1, 0, 0}, 0.3, 0.3});
  const FieldNodeId other = tube_of(field, {{-1, 0, 0}, {1, 0, 0}, 0.2, 0.2});
  field.root = add(field, Contact{}, {one, other});
  const CrossingSearch found =
      traced(tracer_of(field), Ray{.origin = {0.5, 0, 0}, .direction = UnitVec3::unchecked({-1, 0, 0})});
  ASSERT_TRUE(found.t);
  EXPECT_NEAR(*found.t, 1.5 + 0.25, 0.1);
  EXPECT_LT(found.evaluations, 10000u);
}

}  // namespace
}  // namespace marrow::test
