// The 1/r^3 convolution segment: its integral, its radius, its bounds.
#include <numbers>

#include "field/tree/nodes/convolution_segment.h"
#include "tests/tree/node_laws.h"

namespace marrow {
namespace {

template <class Node>
struct FieldOf {
  const Node& node;
  template <Number X>
  X operator()(const Vec3<X>& p) const {
    return node.value(p);
  }
};

// Simpson's rule on the raw definition.
double integral(double h2, double a, double b) {
  constexpr int n = 20000;
  const auto k = [&](double t) { return 1 / ((h2 + t * t) * std::sqrt(h2 + t * t)); };
  double sum = k(a) + k(b);
  for (int i = 1; i < n; ++i) sum += (i % 2 ? 4 : 2) * k(a + (b - a) * i / n);
  return sum * (b - a) / n / 3;
}

TEST(Convolution, ClosedFormIsTheIntegral) {
  test::Random random(61);
  for (int i = 0; i < 100; ++i) {
    const double h2 = std::pow(random.between(0.2, 2), 2), a = random.between(-3, 3), b = a + random.between(0, 3);
    const double expected = integral(h2, a, b);
    EXPECT_NEAR(inverse_cube_integral(h2, a, b), expected, 1e-9 * expected);
  }
  EXPECT_NEAR(inverse_cube_integral(1e-30, 1.0, 2.0), 0.5 * (1 - 0.25), 1e-15);  // on the line, behind an end
  EXPECT_NEAR(inverse_cube_integral(1e-30, -2.0, -1.0), 0.5 * (1 - 0.25), 1e-15);
}

TEST(Convolution, LongSegmentHasItsRadius) {
  const ConvolutionSegment line{{-1e6, 0, 0}, {1e6, 0, 0}, {0.7}};
  EXPECT_NEAR(line.value(Vec3d{3, 0.7, 0}), 1, 1e-10);
}

// In the middle of a segment of length 10 whose radius rises by 0.15 for each unit, from 0.25 on.
TEST(Convolution, RadiusIsThatOfTheFoot) {
  const ConvolutionSegment rod{{0, 0, 0}, {10, 0, 0}, {0.25, 1.75}};
  const ConvolutionSegment same{{0, 0, 0}, {10, 0, 0}, {1}};
  EXPECT_NEAR(rod.value(Vec3d{5, 1, 0}), same.value(Vec3d{5, 1, 0}), 1e-12);
  EXPECT_NEAR(rod.value(Vec3d{5, 1, 0}), 0.9806, 5e-5);
  EXPECT_NEAR(rod.value(Vec3d{-1, 0.3, 0}), 0.0625 * same.value(Vec3d{-1, 0.3, 0}), 1e-12);  // clamped to the end
}

TEST(Convolution, PiecesAddUp) {
  test::Random random(62);
  const ConvolutionSegment whole{{0, 0, 0}, {1, 2, 2}, {0.4}}, first{{0, 0, 0}, {0.25, 0.5, 0.5}, {0.4}},
      second{{0.25, 0.5, 0.5}, {1, 2, 2}, {0.4}};
  for (int i = 0; i < 1000; ++i) {
    const Vec3d p = random.vector(3);
    EXPECT_NEAR(first.value(p) + second.value(p), whole.value(p), 1e-12 * whole.value(p));
  }
}

TEST(Convolution, Laws) {
  const ConvolutionSegment rod{{-1, 0.1, 0}, {1, 0.4, 0.3}, {0.3, 0.8}}, stub{{0, 0, 0}, {0, 0.01, 0}, {1}};
  test::expect_lawful(FieldOf<ConvolutionSegment>{rod}, 63, 3000);
  test::expect_lawful(FieldOf<ConvolutionSegment>{stub}, 64, 300);
}

// On the line, where an end's surface is, too.
TEST(Convolution, EnclosuresAreTightAtTheTip) {
  const ConvolutionSegment rod{{0, 0, 0}, {5, 0, 0}, {1}};
  const double size = 1e-3;
  const Vec3<test::Enclosure> p{test::Enclosure::variable({-0.5 - size, -0.5}, 0),
                                test::Enclosure::variable({-size, size}, 1),
                                test::Enclosure::variable({-size, size}, 2)};
  const auto f = rod.value(p);
  EXPECT_LT(f.value.width(), 0.02);
  EXPECT_GT(f.slope[0].lo, 0);
  EXPECT_LT(f.slope[1].width(), 0.5);
}

TEST(Convolution, ExtentHoldsTheLevel) {
  test::Random random(65);
  const ConvolutionSegment rod{{-1, 0.1, 0}, {1, 0.4, 0.3}, {0.3, 0.8}};
  for (const double level : {0.1, 1.0, 5.0}) {
    const Box3 box = rod.extent(level);
    for (int i = 0; i < 5000; ++i) {
      const Vec3d p = random.vector(4);
      if (!box.contains(p)) { EXPECT_LT(rod.value(p), level); }
    }
  }
}

TEST(Convolution, SkeletonIsInside) {
  const ConvolutionSegment rod{{0, 0, 0}, {5, 0, 0}, {1}};
  EXPECT_GT(rod.value(Vec3d{2, 0, 0}), 1e12);
  EXPECT_TRUE(std::isfinite(rod.value(Vec3d{0, 0, 0})));
}

}  // namespace
}  // namespace marrow
