// Warps: inverses of the deformations they are named for, supports, enclosures.
#include <algorithm>
#include <numbers>

#include "field/number/places_in.h"
#include "field/tree/nodes/bend.h"
#include "field/tree/nodes/shear.h"
#include "field/tree/nodes/taper.h"
#include "field/tree/nodes/twist.h"
#include "tests/tree/node_laws.h"

namespace marrow {
namespace {

constexpr double deg = std::numbers::pi / 180;

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-12) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}

// Points that look into the child's box are in the support.
template <class Node>
void expect_support_holds(const Node& node, unsigned seed) {
  test::Random random(seed);
  for (int scene = 0; scene < 20; ++scene) {
    Box3 child;
    for (int k = 0; k < 2; ++k)
      child.include(Vec3d{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
    const Box3 support = node.support(child);
    for (int i = 0; i < 2000; ++i) {
      const Vec3d p{random.between(-4, 4), random.between(-4, 4), random.between(-4, 4)};
      if (child.contains(node.child_point(p))) { EXPECT_TRUE(support.contains(p)) << "seed " << seed; }
    }
    EXPECT_LT(max_component(support.size()), 20);
  }
  Box3 half = Box3{{-1, -1, -1}, {1, 1, 1}};
  half.upper.y = Box3::inf;
  const Box3 all = node.support(half);
  EXPECT_TRUE(all.contains(Vec3d{1e9, 1e9, 1e9}) && all.contains(Vec3d{-1e9, -1e9, -1e9}));
}

template <class Node>
void expect_lawful_warp(const Node& node, unsigned seed) {
  for (const std::size_t axis : {0u, 1u, 2u}) test::expect_lawful(test::WarpCoordinate<Node>{node, axis}, seed, 200);
}

const Twist twist{{0.1, 0.2, 0}, normalize({1, 2, 0.5}), 70 * deg};
const Taper taper{{0, -0.5, 0.1}, normalize({0.2, 1, 0.1}), 1.2, 1.5, 0.4};
const Shear shear{{0.3, 0, 0}, normalize({0, 1, 0.2}), normalize({1, 0.3, 0}), 0.8};
const Bend bend{{0.1, 0, 0}, normalize({0, 1, 0.1}), normalize({1, 0.2, 0}), 1.4, 100 * deg};

TEST(Warps, Laws) {
  expect_lawful_warp(twist, 41);
  expect_lawful_warp(taper, 42);
  expect_lawful_warp(shear, 43);
  expect_lawful_warp(bend, 44);
  expect_lawful_warp(Bend{.angle = 0}, 45);
  expect_lawful_warp(Bend{.length = 3, .angle = 360 * deg}, 46);
}

// In boxes on every side of the arc's centre and right at it, as far as they are not on the cut.
TEST(Warps, AnglesOfBendsHoldAboutTheCentreOfTheArc) {
  const Bend whole{.length = 2 * std::numbers::pi, .angle = 360 * deg};  // of radius 1, which nothing lies behind
  test::Random random(47);
  int asked = 0;
  for (int i = 0; i < 20'000 && !testing::Test::HasFailure(); ++i) {
    const double size = pow(10, random.between(-300, 0));
    Box3 box;
    for (int k = 0; k < 2; ++k) box.include(Vec3d{1 + random.between(-size, size), random.between(-size, size), 0});
    if (box.upper.x >= 1 && box.lower.y <= 0 && box.upper.y >= 0) continue;  // the half-line behind the centre
    ++asked;
    const Vec3<Interval> held = whole.child_point(places_in(box));
    for (int k = 0; k < 8; ++k) {
      const Vec3d p{random.between(box.lower.x, box.upper.x), random.between(box.lower.y, box.upper.y), 0};
      const double angle = std::atan2(p.y, 1 - p.x);
      EXPECT_TRUE(held.y.lo - 1e-14 <= angle && angle <= held.y.hi + 1e-14) << "box " << i << ", size " << size;
      EXPECT_NEAR(whole.child_point(p).y, angle, 1e-14) << "box " << i << ", size " << size;
    }
  }
  EXPECT_GT(asked, 8'000);
}

TEST(Warps, Supports) {
  expect_support_holds(twist, 51);
  expect_support_holds(taper, 52);
  expect_support_holds(shear, 53);
  expect_support_holds(bend, 54);
  expect_support_holds(Bend{.angle = 0}, 55);
}

TEST(Warps, TwistTurnsByItsAngle) {
  const Twist quarter{{0, 0, 0}, UnitVec3::unchecked({0, 0, 1}), 90 * deg};
  expect_near(quarter.child_point(Vec3d{0, 1, 1}), {1, 0, 1});
  expect_near(quarter.child_point(Vec3d{1, 0, 0}), {1, 0, 0});
}

TEST(Warps, TaperScalesAcrossItsAxis) {
  const Taper cone{{0, 0, 0}, UnitVec3::unchecked({0, 1, 0}), 2, 1, 0.5};
  expect_near(cone.child_point(Vec3d{1, -3, 0}), {1, -3, 0});
  expect_near(cone.child_point(Vec3d{0.75, 1, 0}), {1, 1, 0});
  expect_near(cone.child_point(Vec3d{0.5, 9, 0.5}), {1, 9, 1});
}

TEST(Warps, ShearSlides) {
  const Shear slide{{0, 1, 0}, UnitVec3::unchecked({0, 1, 0}), normalize({1, 5, 0}), 0.5};
  expect_near(slide.child_point(Vec3d{2, 3, 1}), {1, 3, 1});
  EXPECT_EQ(slide.problem(1), "");
  EXPECT_NE((Shear{{}, UnitVec3::unchecked({0, 1, 0}), UnitVec3::unchecked({0, -1, 0}), 1}.problem(1)), "");
}

// A straight bar becomes an arc; its ends go on straight, across the ends of the arc.
TEST(Warps, BendMakesAnArc) {
  const double length = 2, angle = 180 * deg, radius = length / angle;
  const Bend half{{0, 0, 0}, UnitVec3::unchecked({0, 1, 0}), UnitVec3::unchecked({1, 0, 0}), length, angle};
  expect_near(half.child_point(Vec3d{0, 0, 0.4}), {0, 0, 0.4});
  for (double t = -0.99; t < 1; t += 0.1) {
    const double at = t / radius;
    for (const double height : {0.0, 0.2, -0.3}) {
      const Vec3d p{radius - (radius - height) * std::cos(at), (radius - height) * std::sin(at), 0};
      expect_near(half.child_point(p), {height, t, 0});
    }
  }
  expect_near(half.child_point(Vec3d{radius + 0.5, radius, 0}), {0, 1.5, 0});
  expect_near(half.child_point(Vec3d{radius + 0.5, radius + 0.1, 0}), {-0.1, 1.5, 0});
  expect_near(half.child_point(Vec3d{radius + 0.5, -radius, 0}), {0, -1.5, 0});
}

// Where the ends of a ring meet, slopes are those nearby, however near its cut.
TEST(Warps, BendHasSlopesBesideItsCut) {
  const Bend ring{.axis = UnitVec3::unchecked({0, 1, 0}), .length = 3, .angle = 360 * deg};
  const double behind = 2 * 3 / (2 * std::numbers::pi) + 0.1;
  const auto child_at = [&](double y) {
    return ring.child_point(Vec3<test::Slope>{test::Slope::variable(behind, 0), test::Slope::variable(y, 1),
                                              test::Slope::variable(0.2, 2)});
  };
  for (const double side : {-1.0, 1.0}) {
    const auto nearby = child_at(side * 1e-9);
    for (const double y : {side * 1e-160, side * 1e-300, side * 5e-324}) {
      const auto beside = child_at(y);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(beside[k].value, nearby[k].value, 1e-8) << y;
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(beside[k].slope[i], nearby[k].slope[i], 1e-8) << y;
      }
    }
  }
}

// Behind the centre of the circle a box holds what belongs to both ends: small places each, not all that lies between.
TEST(Warps, BendTakesABoxOnItsCutToBothSides) {
  test::Random random(77);
  int cut = 0;
  for (int scene = 0; scene < 4000; ++scene) {
    const Bend warp{.center = random.vector(1),
                    .axis = UnitVec3::unchecked({0, 1, 0}),
                    .length = random.between(0.5, 3),
                    .angle = (scene % 7 == 0 ? 360 : random.between(5, 360)) * deg};
    const double radius = warp.length / warp.angle, away = radius * random.between(0, 2), size = 0.1 * radius;
    const Vec3d middle = warp.center + Vec3d{radius + away, random.between(-size, size), random.between(-1, 1)};
    const Vec3d half{random.between(0, size), random.between(0, size), random.between(0, size)};
    const auto side = [&](std::size_t i) { return Interval(middle[i] - half[i], middle[i] + half[i]); };
    const Vec3<Interval> box{side(0), side(1), side(2)};
    Bend::Sides<Interval> places;
    const std::size_t count = warp.sides(box, places);
    cut += count > 0;
    for (int i = 0; i < 20 && count > 0; ++i) {
      const Vec3d child =
          warp.child_point(middle + Vec3d{half.x * random.between(-1, 1), half.y * random.between(-1, 1),
                                          half.z * random.between(-1, 1)});
      const auto holds = [&](const Vec3<Interval>& place) {
        return place.x.contains(child.x) && place.y.contains(child.y) && place.z.contains(child.z);
      };
      EXPECT_TRUE(std::any_of(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count), holds))
          << "seed 77, scene " << scene;
    }
    if (away < 3 * size) continue;  // at the centre of the circle all of the arc is near
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(places[i][k].hi - places[i][k].lo, 8 * size) << "scene " << scene;
  }
  EXPECT_GT(cut, 1000);
}

}  // namespace
}  // namespace marrow
