// Soft set operations: crisp outside the two control rays, smooth between, control by each side.
#include "field/tree/nodes/soft_csg.h"

#include <limits>

#include "tests/tree/node_laws.h"

namespace marrow {
namespace {

using test::field_of;

TEST(SoftCsg, CrispOutsideTheControlRays) {
  test::Random random(3);
  const SoftUnion both{.on_first = 0.3, .on_second = 0.7};
  const SoftIntersection common{.on_first = 1.2, .on_second = 1.9};
  for (int i = 0; i < 20000; ++i) {
    const double x = random.between(0, 3), y = random.between(0, 3), most = std::max(x, y), least = std::min(x, y);
    const bool soft = y > 0.3 * x && x > 0.7 * y, round = y < 1.2 * x && x < 1.9 * y;
    EXPECT_EQ(field_of(both, {x, y}) > most, soft) << x << ' ' << y;
    if (!soft) { EXPECT_EQ(field_of(both, {x, y}), most); }
    EXPECT_EQ(field_of(common, {x, y}) < least, round) << x << ' ' << y;
    if (!round) { EXPECT_EQ(field_of(common, {x, y}), least); }
  }
}

// The quarter of an ellipse between the two control points, by its own parameter.
TEST(SoftCsg, SurfaceIsTheEllipse) {
  for (double angle = 0.01; angle < 1.57; angle += 0.01) {
    const double c = std::cos(angle), s = std::sin(angle);
    EXPECT_NEAR(field_of(SoftUnion{.on_first = 0.3, .on_second = 0.6}, {0.6 + 0.4 * c, 0.3 + 0.7 * s}), 1, 1e-14);
    EXPECT_NEAR(field_of(SoftIntersection{.on_first = 1.5, .on_second = 1.2}, {1.2 - 0.2 * c, 1.5 - 0.5 * s}), 1,
                1e-14);
    EXPECT_NEAR(field_of(SoftDifference{.on_first = 0.5, .on_second = 1.2}, {1.2 - 0.2 * c, 2 - (1.5 - 0.5 * s)}), 1,
                1e-14);
  }
}

TEST(SoftCsg, CreasesAreTheLimit) {
  test::Random random(4);
  for (const double soft : {1e-3, 1e-6, 1e-9, 0.0}) {
    for (int i = 0; i < 1000; ++i) {
      const double x = random.between(0, 2),
                   y = i % 2 ? random.between(0, 2) : x * (1 + soft * (random.between(0, 2) - 1));
      EXPECT_NEAR(field_of(SoftUnion{1 - soft, 1 - soft}, {x, y}), std::max(x, y), 2 * soft + 1e-15);
      EXPECT_NEAR(field_of(SoftIntersection{1 + soft, 1 + soft}, {x, y}), std::min(x, y), 2 * soft + 1e-15);
      EXPECT_NEAR(field_of(SoftDifference{1 - soft, 1 + soft}, {x, y}), std::min(x, 2 - y), 2 * soft + 1e-15);
    }
  }
}

TEST(SoftCsg, SlopesAreContinuousAndBounded) {
  using test::Slope;
  const EllipseCorner corners[]{{0.2, 0.7}, {0, 0}, {0.95, 0.5}, {1.2, 1.8}, {3, 1.2}};
  for (const EllipseCorner& corner : corners) {
    Slope last;
    for (int i = 0; i <= 20000; ++i) {
      const double angle = 1.5707 * i / 20000;
      const Slope c = corner.value(Slope::variable(std::cos(angle), 0), Slope::variable(std::sin(angle), 1));
      for (const std::size_t k : {0u, 1u}) {
        EXPECT_GE(c.slope[k], -1e-12);
        EXPECT_LE(c.slope[k], 1 + 1e-12);
        if (i > 0) {
          EXPECT_NEAR(c.slope[k], last.slope[k], 0.05) << corner.a << ' ' << corner.b << " angle " << angle;
        }
      }
      last = c;
    }
  }
}

TEST(SoftCsg, Laws) {
  test::expect_lawful_operator(SoftUnion{}, 3, 21);
  test::expect_lawful_operator(SoftUnion{0, 0.9}, 2, 22);
  test::expect_lawful_operator(SoftUnion{1, 0.4}, 3, 23);
  test::expect_lawful_operator(SoftIntersection{1.3, 2}, 3, 24);
  test::expect_lawful_operator(SoftDifference{0.1, 1.5}, 3, 25);
  for (const std::size_t children : {1u, 2u, 5u}) {
    test::expect_child_level(SoftUnion{}, children, 26);
    test::expect_child_level(SoftUnion{0, 0}, children, 27);
  }
}

// What is not there does not count.
TEST(SoftCsg, NothingAddsNothing) {
  EXPECT_EQ(field_of(SoftUnion{0, 0}, {0.7, 0, 0}), 0.7);
  EXPECT_EQ(field_of(SoftUnion{0, 0}, {0, 0.7}), 0.7);
  EXPECT_EQ(field_of(SoftIntersection{}, {0, 0.7}), 0);
  EXPECT_EQ(field_of(SoftIntersection{}, {0.7, 0}), 0);
  EXPECT_EQ(field_of(SoftDifference{}, {0.7, 0}), 0.7);
  EXPECT_EQ(field_of(SoftDifference{}, {0, 0.7}), 0);
  EXPECT_EQ(field_of(SoftDifference{}, {5, 2}), 0);
}

// On skeletons, and beside them, where squares overflow.
TEST(SoftCsg, HoldsForInfiniteAndLargeFields) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double control : {0.0, 0.5, 0.9}) {
    EXPECT_EQ(field_of(SoftUnion{control, control}, {inf, 0}), inf);
    EXPECT_EQ(field_of(SoftUnion{control, control}, {0.5, inf}), inf);
    EXPECT_EQ(field_of(SoftUnion{control, control}, {inf, inf}), inf);
    const double ratio = field_of(SoftUnion{control, control}, {3, 2.9});
    for (const double large : {1e90, 1e150, 1e200, 1e300})
      EXPECT_NEAR(field_of(SoftUnion{control, control}, {3 * large, 2.9 * large}) / large, ratio, 1e-13);
    const Interval boxes[] = {{2, inf}, {3, inf}};
    const Interval value = SoftUnion{control, control}.value(std::span<const Interval>(boxes));
    EXPECT_TRUE(value.lo >= 3 * (1 - 1e-12) && value.hi == inf) << control;
  }
  EXPECT_EQ(field_of(SoftIntersection{}, {inf, inf}), inf);
  EXPECT_EQ(field_of(SoftIntersection{}, {inf, 0.5}), 0.5);
  EXPECT_EQ(field_of(SoftDifference{}, {inf, 0}), 2);
  EXPECT_EQ(field_of(SoftDifference{}, {inf, inf}), 0);
}

}  // namespace
}  // namespace marrow
