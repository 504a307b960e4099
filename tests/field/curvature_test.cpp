// Hessians against differences, and the curvature of known shapes.
#include "field/blend/curvature.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "tests/field/random.h"

namespace marrow {
namespace {

using test::numeric_gradient;
using test::Random;
using test::random_blend;

double magnitude(const Matrix3& m) { return length(m.rows[0]) + length(m.rows[1]) + length(m.rows[2]); }

TEST(Hessian, IsTheDerivativeOfTheGradientForEverySkeletonAndKernel) {
  Random random(601);
  int checked = 0;
  for (int i = 0; i < 600; ++i) {
    BlendField blend = random_blend(random, random.whole(3, 7), 1, true, Projection::Paper);
    blend.arcs.add(random.arc(), {});
    if (i % 8 == 0) blend.triangles.add(random.triangle(), {});
    if (i % 3 == 1) {
      blend.kernel = KernelFamily::Cauchy;
      blend.triangles = {};
    }
    const Vec3d p = random.vector(2);
    const SkeletonSample s = sum_of_primitives<Derivatives::First>(blend, p);
    if (s.value > 20) continue;
    const Matrix3 hessian = sum_hessian(blend, p), beside = sum_hessian(blend, p + Vec3d{3e-4, 3e-4, 3e-4});
    if (magnitude(hessian + beside * -1.0) > 1e-2 * magnitude(hessian)) continue;  // an end of a distance segment
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component = [&](const Vec3d& q) {
        return sum_of_primitives<Derivatives::First>(blend, q).gradient[k];
      };
      EXPECT_LE(length(numeric_gradient(component, p, 2e-4) - hessian.rows[k]), 1e-5 * magnitude(hessian)) << i;
    }
    ++checked;
  }
  EXPECT_GT(checked, 300);
}

// Of a ball all surfaces of one value are balls. Squares of fields leave the range of doubles at 1e-154.
TEST(Hessian, IsThatOfABallHoweverFarAway) {
  Random random(612);
  for (int i = 0; i < 2000; ++i) {
    BlendField ball;
    ball.degree = random.whole(3, 20);
    ball.alpha = random.between(0, 1.5);
    ball.points.add({{0, 0, 0}, 1}, {});
    const double distance = std::pow(10, random.between(0, 130) / ball.degree);
    const Vec3d p = normalize(random.vector(1)).vec() * distance;
    const Curvature c = curvature_of(evaluate(ball, p).corrected_gradient, corrected_hessian(ball, p));
    EXPECT_NEAR(c.mean * distance, 1, 1e-9) << "degree " << ball.degree << ", " << distance << " away";
  }
}

TEST(Curvature, IsThatOfABallAndOfATube) {
  Random random(602);
  for (int i = 0; i < 50; ++i) {
    const double radius = random.between(0.1, 3);
    BlendField ball;
    ball.degree = random.whole(3, 8);
    ball.alpha = random.between(0, 1.5);
    ball.points.add({{0, 0, 0}, radius}, {});
    const Vec3d p = normalize(random.vector(1)).vec() * radius;
    for (const Matrix3& hessian : {sum_hessian(ball, p), corrected_hessian(ball, p)}) {
      const Curvature c = curvature_of(evaluate(ball, p).corrected_gradient, hessian);
      EXPECT_NEAR(c.mean * radius, 1, 1e-12);
      EXPECT_NEAR(c.gaussian * radius * radius, 1, 1e-12);
    }
    BlendField tube;
    tube.degree = 5;
    tube.segments.add({{-1e3 * radius, 0, 0}, {1e3 * radius, 0, 0}, radius, radius}, {});
    const Vec3d side{0, radius * 0.6, radius * 0.8};
    const Curvature c = curvature_of(evaluate(tube, side).sum_gradient, sum_hessian(tube, side));
    EXPECT_NEAR(c.mean * radius, 0.5, 1e-6);
    EXPECT_NEAR(c.gaussian * radius * radius, 0, 1e-6);
  }
}

TEST(Curvature, OfTheCorrectedFieldFollowsFromItsGradient) {
  Random random(603);
  int checked = 0;
  for (int i = 0; i < 200; ++i) {
    const BlendField blend = random_blend(random, 4, 1.1, true, Projection::Exact);
    const Vec3d p = random.vector(2.5);
    const BlendSample s = evaluate(blend, p);
    if (s.corrected < 0.2 || s.corrected > 5) continue;
    const Matrix3 hessian = corrected_hessian(blend, p), beside = corrected_hessian(blend, p + Vec3d{1e-3, 1e-3, 1e-3});
    if (magnitude(hessian + beside * -1.0) > 2e-2 * magnitude(hessian)) continue;
    const auto mean_at = [&](const Vec3d& q) {
      const Vec3d g = evaluate(blend, q).corrected_gradient;
      return g / -length(g);
    };
    double divergence = 0;
    for (std::size_t k = 0; k < 3; ++k)
      divergence += numeric_gradient([&](const Vec3d& q) { return mean_at(q)[k]; }, p, 3e-4)[k];
    EXPECT_NEAR(curvature_of(s.corrected_gradient, hessian).mean, divergence / 2, 1e-4 * (1 + std::fabs(divergence)));
    ++checked;
  }
  EXPECT_GT(checked, 40);
}

}  // namespace
}  // namespace marrow
