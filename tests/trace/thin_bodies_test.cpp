// What is thin against where it stands, or against the way to it, is met by the tracer of general trees.
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "tests/trace/traced_trees.h"

namespace marrow::test {
namespace {

// However many sizes away a ray begins, what it meets is as thin as where it stands tells.
TEST(ThinBodies, AreFoundFromFarAway) {
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

// A film that is thinner than what a search tells may be met or not, but by all ends of a ray alike.
TEST(ThinBodies, AreMetAlikeWhereverTheRayEnds) {
  Random random(50);
  FieldDescription field;
  const auto tube = [&](double radius) {
    return add(field, Cylinder{.from = {-0.7, 0, 0}, .to = {0.7, 0, 0}, .radius = radius, .potential = {}});
  };
  const FieldNodeId film = add(field, Difference{}, {tube(0.5 + 8e-12), tube(0.5)});
  field.root = field.add({.what = Union{{film, tube(0.4998)}}, .where = {}});
  const TreeTracer tracer = tracer_of(field);
  int unlike = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3d from = normalize(random.vector(1)) * 4, to{random.between(-0.6, 0.6), random.between(-0.4, 0.4), 0};
    Ray ray{.origin = from, .direction = normalize(to - from)};
    const CrossingSearch found = traced(tracer, ray);
    ASSERT_TRUE(found.t);
    ray.t_max = *found.t - pow(10.0, random.between(-8, -3));
    for (std::size_t cell = 0; cell < tracer.cell_count(); ++cell) {
      CellLog any, first;
      unlike +=
          tracer.first_hit(cell, ray, true, any).has_value() != tracer.first_hit(cell, ray, false, first).has_value();
    }
  }
  EXPECT_EQ(unlike, 0);
}

// However far from the origin a body stands, of it parts are told that are thin against it.
TEST(ThinBodies, AreFoundFarFromTheOrigin) {
  Random random(49);
  for (const double thickness : {1e-4, 1e-6, 1e-7}) {
    const Vec3d center{2.3e4, 3e4, 9e3};
    FieldDescription field;
    const FieldNodeId outer = add(field, Sphere{.center = center, .radius = 1, .potential = {}});
    const FieldNodeId inner = add(field, Sphere{.center = center, .radius = 1 - thickness, .potential = {}});
    const FieldNodeId ball = add(field, Sphere{.center = center, .radius = 1 - 4 * thickness, .potential = {}});
    const FieldNodeId shell = add(field, Difference{}, {outer, inner});
    field.root = add(field, Ricci{1}, {field.add({.what = Union{{shell, ball}}, .where = {}})});
    const TreeTracer tracer = tracer_of(field);
    for (int i = 0; i < 50; ++i) {
      const UnitVec3 direction = normalize(random.vector(1));
      const CrossingSearch found = traced(tracer, {.origin = center - direction * 3.0, .direction = direction});
      ASSERT_TRUE(found.t);
      EXPECT_NEAR(*found.t, 2, 1e-10) << "thickness " << thickness;
      EXPECT_GT(found.undecided, 1e300);
    }
  }
}

}  // namespace
}  // namespace marrow::test
