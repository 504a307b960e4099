// Sharp set operations: the crisp surface, a field without other creases.
#include "field/tree/nodes/sharp_csg.h"

#include <limits>

#include "tests/tree/node_laws.h"

namespace marrow {
namespace {

using test::field_of;
using test::Slope;

TEST(SharpCsg, SurfaceIsCrisp) {
  test::Random random(81);
  for (const double smooth : {0.0, 0.4, 1.0}) {
    for (int i = 0; i < 20000; ++i) {
      const double x = random.between(0, 2), y = random.between(0, 2);
      EXPECT_EQ(field_of(SharpUnion{smooth}, {x, y}) > 1, std::max(x, y) > 1) << x << ' ' << y;
      EXPECT_EQ(field_of(SharpIntersection{smooth}, {x, y}) > 1, std::min(x, y) > 1) << x << ' ' << y;
      EXPECT_EQ(field_of(SharpDifference{smooth}, {x, y}) > 1, std::min(x, 2 - y) > 1) << x << ' ' << y;
    }
    EXPECT_EQ(field_of(SharpUnion{smooth}, {1, 0.99}), 1);
    EXPECT_EQ(field_of(SharpIntersection{smooth}, {1, 1.01}), 1);
  }
}

TEST(SharpCsg, BetweenTheCrispAndTheSoft) {
  test::Random random(82);
  for (int i = 0; i < 20000; ++i) {
    const double x = random.between(0, 1), y = random.between(0, 1);
    const double both = field_of(SharpUnion{0.7}, {x, y}), common = field_of(SharpIntersection{0.7}, {x, y});
    EXPECT_GE(both, std::max(x, y));
    EXPECT_LE(both, std::min(1.0, EllipseCorner{0.3, 0.3}.value(x, y) + 1e-15));
    EXPECT_LE(common, std::min(x, y));
    EXPECT_GE(common, EllipseCorner({1.7, 1.7}).value(x, y) - 1e-15);
  }
}

// Along a line through the rounding, and along one that meets the surface beside the crease.
TEST(SharpCsg, SlopesAreContinuousButForTheCrease) {
  for (const SharpCorner& corner : {SharpCorner{0.2, 0.6}, SharpCorner{0, 0}, SharpCorner{1.3, 1.8}}) {
    for (const bool across : {true, false}) {
      Slope last;
      for (int i = 0; i <= 20000; ++i) {
        const double t = i / 20000.0;
        const double x = across ? 0.6 * t : 0.5 + t, y = across ? 0.6 * (1 - t) : 0.3 + t;
        const Slope c = corner.value(Slope::variable(x, 0), Slope::variable(y, 1));
        for (const std::size_t k : {0u, 1u}) {
          EXPECT_GE(c.slope[k], -1e-9);
          EXPECT_LE(c.slope[k], 1 + 1e-9);
          if (i > 0) { EXPECT_NEAR(c.slope[k], last.slope[k], 0.05) << corner.a << ' ' << x << ' ' << y; }
        }
        last = c;
      }
    }
  }
}

TEST(SharpCsg, Laws) {
  test::expect_lawful_operator(SharpUnion{1}, 3, 83);
  test::expect_lawful_operator(SharpUnion{0.3}, 2, 84);
  test::expect_lawful_operator(SharpIntersection{1}, 2, 85);
  test::expect_lawful_operator(SharpIntersection{0.4}, 3, 86);
  test::expect_lawful_operator(SharpDifference{0.8}, 3, 87);
  for (const std::size_t children : {1u, 2u, 5u}) test::expect_child_level(SharpUnion{}, children, 88);
}

// The tracer needs slopes whose sign is sure wherever the surface is not near the crease.
TEST(SharpCsg, SlopesOnTheSurfaceAreThoseOfOneSide) {
  using test::Enclosure;
  const Interval at_surface{1 - 1e-3, 1 + 1e-3};
  for (const Interval& other : {Interval(0, 0.5), Interval(0.9, 0.99)}) {
    const Enclosure f[]{Enclosure::variable(at_surface, 0), Enclosure::variable(other, 1)};
    const Enclosure c = SharpUnion{}.value(std::span<const Enclosure>(f));
    EXPECT_NEAR(c.slope[0].lo, 1, 1e-12);
    EXPECT_NEAR(c.slope[0].hi, 1, 1e-12);
    EXPECT_NEAR(c.slope[1].lo, 0, 1e-12);
    EXPECT_NEAR(c.slope[1].hi, 0, 1e-12);
  }
  for (const Interval& other : {Interval(1.01, 1.02), Interval(1.3, 2)}) {
    const Enclosure f[]{Enclosure::variable(other, 0), Enclosure::variable(at_surface, 1)};
    const Enclosure c = SharpIntersection{}.value(std::span<const Enclosure>(f));
    EXPECT_NEAR(c.slope[0].lo, 0, 1e-12);
    EXPECT_NEAR(c.slope[0].hi, 0, 1e-12);
    EXPECT_NEAR(c.slope[1].lo, 1, 1e-12);
    EXPECT_NEAR(c.slope[1].hi, 1, 1e-12);
  }
}

TEST(SharpCsg, HoldsForInfiniteAndLargeFields) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double smooth : {0.0, 0.5, 1.0}) {
    EXPECT_EQ(field_of(SharpUnion{smooth}, {inf, 0.2}), inf);
    EXPECT_EQ(field_of(SharpUnion{smooth}, {3, inf}), inf);
    EXPECT_EQ(field_of(SharpUnion{smooth}, {inf, inf}), inf);
    EXPECT_GE(field_of(SharpUnion{smooth}, {1e200, 0.9e200}), 1e200);
    EXPECT_EQ(field_of(SharpIntersection{smooth}, {inf, 0.2}), 0.2);
    EXPECT_EQ(field_of(SharpIntersection{smooth}, {inf, inf}), inf);
    EXPECT_EQ(field_of(SharpDifference{smooth}, {inf, 0}), 2);
    EXPECT_EQ(field_of(SharpDifference{smooth}, {inf, inf}), 0);
  }
}

TEST(SharpCsg, NothingAddsNothing) {
  EXPECT_EQ(field_of(SharpUnion{}, {0.7, 0, 0}), 0.7);
  EXPECT_EQ(field_of(SharpUnion{}, {0, 1.7}), 1.7);
  EXPECT_EQ(field_of(SharpIntersection{}, {0, 0.7}), 0);
  EXPECT_EQ(field_of(SharpDifference{}, {0, 0.7}), 0);
  EXPECT_EQ(field_of(SharpDifference{}, {0.7, 0}), 0.7);
}

}  // namespace
}  // namespace marrow
