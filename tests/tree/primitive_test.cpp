// Primitives have their surfaces where users expect them, and their fields fall with the distance to them.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/tree/laws.h"
#include "tests/tree/random_node.h"

namespace marrow::test {
namespace {

constexpr WyvillProfile wide{8};

/// The distance that gives this field; the potential must not be constant there.
double distance_of(double field) {
  double low = -6, high = 8;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (bounded_field(wide, middle) > field ? low : high) = middle;
  }
  return low;
}
template <class Kind>
double distance(const Kind& node, const Vec3d& p) {
  return distance_of(node.value(p));
}

TEST(Primitive, SphereAndEllipsoid) {
  EXPECT_NEAR(distance(Sphere{{1, 2, 3}, 0.5, wide}, {1, 4, 3}), 1.5, 1e-12);
  EXPECT_NEAR(distance(Sphere{{1, 2, 3}, 0.5, wide}, {1, 2, 3.1}), -0.4, 1e-12);
  const Ellipsoid ellipsoid{{1, 0, 0}, {2, 1, 0.5}, wide};
  for (const Vec3d& p : {Vec3d{3, 0, 0}, Vec3d{1, -1, 0}, Vec3d{1, 0, 0.5}})
    EXPECT_NEAR(distance(ellipsoid, p), 0, 1e-12);
  EXPECT_NEAR(distance(ellipsoid, {1, 0, 1.5}), 1, 1e-12);  // along the shortest axis
}

TEST(Primitive, CylinderAndCone) {
  const Cylinder cylinder{{0, 0, -1}, {0, 0, 3}, 0.5, wide};
  EXPECT_NEAR(distance(cylinder, {0, 2, 0}), 1.5, 1e-12);
  EXPECT_NEAR(distance(cylinder, {0.2, 0, 5}), 2, 1e-12);
  EXPECT_NEAR(distance(cylinder, {3.5, 0, 7}), 5, 1e-12);  // from the rim: 3, 4, 5
  EXPECT_NEAR(distance(cylinder, {0.1, 0, 2.8}), -0.2, 1e-12);
  const Cone cone{{0, 0, 0}, {0, 4, 0}, {3, 0}, wide};  // its side is 5 long
  EXPECT_NEAR(distance(cone, {0, 6, 0}), 2, 1e-12);
  EXPECT_NEAR(distance(cone, {1, -2, 0}), 2, 1e-12);
  EXPECT_NEAR(distance(cone, {1.5 + 4.0 / 5, 2 + 3.0 / 5, 0}), 1, 1e-12);  // straight off the middle of its side
  EXPECT_NEAR(distance(cone, {0, 1, 0}), -1, 1e-12);
  EXPECT_NEAR(distance(cone, {0, 2, 0}), -1.2, 1e-12);  // 2 * 3/5 from the side
  const Cone cut{{0, 0, 0}, {0, 1, 0}, {1, 2}, wide};
  EXPECT_NEAR(distance(cut, {5, 5, 0}), 5, 1e-12);
}

TEST(Primitive, BoxTorusPlaneAndDisc) {
  const Box box{{0, 0, 0}, {2, 4, 6}, 0, wide};
  EXPECT_NEAR(distance(box, {4, 2, 7}), 5, 1e-12);
  EXPECT_NEAR(distance(box, {0.5, 0, 0}), -0.5, 1e-12);
  const Box round{{0, 0, 0}, {2, 4, 6}, 0.5, wide};
  EXPECT_NEAR(distance(round, {1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(distance(round, {1, 2, 0}), 0.5 * (std::numbers::sqrt2 - 1), 1e-12);
  const Torus torus{{0, 0, 0}, UnitVec3::unchecked({0, 0, 1}), 2, 0.5, wide};
  EXPECT_NEAR(distance(torus, {0, 5, 4}), 4.5, 1e-12);
  EXPECT_NEAR(distance(torus, {0, 0, 0}), 1.5, 1e-12);
  EXPECT_NEAR(distance(torus, {2, 0, 0}), -0.5, 1e-12);
  const Plane plane{{0, 1, 0}, normalize({0, 3, 4}), wide};
  EXPECT_NEAR(distance(plane, {9, 4, 4}), 5, 1e-12);
  EXPECT_NEAR(distance(plane, {7, -2, -4}), -5, 1e-12);
  const Disc disc{{0, 0, 0}, UnitVec3::unchecked({0, 1, 0}), 2, 0.5, wide};
  EXPECT_NEAR(distance(disc, {1, 2, 0}), 1.75, 1e-12);
  EXPECT_NEAR(distance(disc, {5, 4, 0}), 4.75, 1e-12);
  EXPECT_NEAR(distance(disc, {1, 0, 1}), -0.25, 1e-12);
}

TEST(Primitive, Line) {
  const LineSolid line{{0, 0, 0}, {4, 0, 0}, {0.5}, wide};
  EXPECT_NEAR(distance(line, {2, 3, 0}), 2.5, 1e-12);
  EXPECT_NEAR(distance(line, {7, 4, 0}), 4.5, 1e-12);
  EXPECT_NEAR(distance(line, {-3, 0, 4}), 4.5, 1e-12);
  // Two balls: in all places the smallest distance to a ball on the way, whose radius changes evenly.
  const LineSolid cone{{0, 0, 0}, {3, 0, 0}, {1.5, 0.3}, wide};
  Random random(41);
  for (int i = 0; i < 100; ++i) {
    const Vec3d p = random.vector(4);
    double nearest = 100;
    for (int k = 0; k <= 4000; ++k) {
      const double t = k / 4000.0;
      nearest = std::min(nearest, length(p - Vec3d{3 * t, 0, 0}) - (1.5 - 1.2 * t));
    }
    EXPECT_NEAR(distance(cone, p), nearest, 1e-6);
  }
  // One ball inside of the other, and both ends in one place.
  EXPECT_NEAR(distance(LineSolid{{0, 0, 0}, {1, 0, 0}, {2, 0.5}, wide}, {4, 0, 0}), 2, 1e-12);
  EXPECT_NEAR(distance(LineSolid{{1, 0, 0}, {1, 0, 0}, {0.5}, wide}, {1, 2, 0}), 1.5, 1e-12);
}

TEST(Primitive, Polygon) {
  // An L, in the plane z = 1.
  const Polygon dented{{{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 3, 1}, {0, 3, 1}}, 0.2, wide};
  EXPECT_NEAR(distance(dented, {0.5, 2, 1}), -0.1, 1e-12);
  EXPECT_NEAR(distance(dented, {1.5, 0.5, 4}), 2.9, 1e-12);
  EXPECT_NEAR(distance(dented, {1.5, 2, 1}), 0.4, 1e-12);  // in the dent
  EXPECT_NEAR(distance(dented, {5, -4, 1}), 4.9, 1e-12);
  EXPECT_EQ(dented.problem(0), "");
  EXPECT_NE((Polygon{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1}}, 0.2, wide}.problem(0)), "");
  EXPECT_NE((Polygon{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 0.2, wide}.problem(0)), "");
}

// What is said to be an exact distance changes by 1 a unit: the slope of the field is that of its potential.
template <class Kind>
void expect_exact_distance() {
  SCOPED_TRACE(std::string(Kind::info.name));
  Random random(42);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    Kind node = random_node<Kind>(0, random);
    node.potential = wide;
    const Vec3d p = random.vector(3);
    const Gradient field = node.value(jet_variables(p));
    if (field.value < 0.01 || field.value > 1.99) continue;
    const double d = distance_of(field.value);
    const double expected = bounded_field(wide, Jet<double, 1>::variable(d, 0)).slope[0];
    EXPECT_NEAR(length(gradient_of(field)), -expected, 1e-6 - 1e-6 * expected);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}
TEST(Primitive, ExactDistancesHaveSlopeOne) {
  expect_exact_distance<Sphere>();
  expect_exact_distance<Cylinder>();
  expect_exact_distance<Cone>();
  expect_exact_distance<Box>();
  expect_exact_distance<Torus>();
  expect_exact_distance<Plane>();
  expect_exact_distance<Disc>();
  expect_exact_distance<LineSolid>();
}

}  // namespace
}  // namespace marrow::test
