// Polynomials stand for sources far away, to within what they state, and their bounds hold.
#include "field/blend/sources/far_polynomial.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "field/blend/local/far_expansion.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

struct Gathered {
  Box3 box;
  SourceSums sums;
  std::unique_ptr<const FarPolynomial> far, marks;
  double allowed;  // of f
};

double norm(const Matrix3& m) {
  double sum = 0;
  for (const Vec3d& row : m.rows) sum += dot(row, row);
  return std::sqrt(sum);
}

Matrix3 difference(const Matrix3& a, const Matrix3& b) { return a + b * -1.0; }

Vec3d direction(Random& random) { return normalize(random.vector(1)).vec(); }

// Those of random sources around a box that are far enough; lists and boxes of all sizes.
Gathered gather(Random& random, int exponent, bool lifted, double error, const FarPolynomial* outer = nullptr,
                const Box3* around = nullptr) {
  const double scale = pow(10.0, random.between(-4, 4));
  const Vec3d center = around ? around->center() + random.vector(0.1 * around->size().x) : random.vector(3 * scale);
  const double half = around ? 0.2 * around->size().x : scale * random.between(0.01, 0.1);
  Gathered g{Box3{center, center}.padded(half), SourceSums(exponent, true), nullptr, nullptr, 0};
  const double share = 1e-4;
  FarExpansion expansion(g.box, lifted, true, error, share);
  for (int i = random.whole(1, 500); i > 0; --i) {
    const double away = 1.7320508 * half * random.between(1.5, 40);
    Source s{.at = center + direction(random) * away, .radius = half * random.between(0.1, 3)};
    if (lifted) s.lift_squared = pow(random.between(0.1, 2) * s.radius, 2);
    s.weight = pow(away, exponent) * pow(10.0, random.between(-7, -1));
    s.mark = 2 * std::sin(i);
    const auto view = expansion.seen(s, exponent);
    if (!view) continue;
    g.sums.add(s);
    g.allowed += error * std::max(view->field, share);
    expansion.add(s, exponent, *view);
  }
  g.far = expansion.polynomial(outer);
  g.marks = expansion.marks(nullptr);
  EXPECT_LE(expansion.f_error(), g.allowed * (1 + 1e-9));
  return g;
}

Vec3d point_in(const Box3& box, Random& random) {
  Vec3d p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = random.between(box.lower[i], box.upper[i]);
  return random.whole(0, 3) == 0 ? (random.whole(0, 1) ? box.lower : box.upper) : p;
}

TEST(FarPolynomial, IsTheSumOfItsSourcesToWithinItsErrors) {
  Random random(20261101);
  double fullest = 0, steep_worst = 0, bent_worst = 0;
  std::size_t gathered = 0;
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const double error = pow(10.0, random.between(-9, -2));
    const Gathered g = gather(random, random.whole(2, 21), round % 2 == 0, error);
    if (g.sums.empty()) continue;
    gathered += g.sums.count();
    const FarPolynomial::Bounds& b = g.far->bounds();
    for (int i = 0; i < 10; ++i) {
      const Vec3d p = point_in(g.box, random);
      const SkeletonSample exact = g.sums.at(p).sum, told = g.far->at(p), values = g.far->value_at(p);
      EXPECT_EQ(told.value, values.value);
      EXPECT_EQ(told.si_gradient, values.si_gradient);
      const double f_off = std::fabs(told.value - exact.value);
      EXPECT_LE(f_off, b.f_error + 1e-12 * exact.value);
      EXPECT_LE(length(told.si_gradient - exact.si_gradient), b.S_error + 1e-12 * b.S_longest);
      const MarkSums marks = g.marks->marks_at(p), exact_marks = g.sums.marks_at(p);
      EXPECT_LE(std::fabs(marks.first - exact_marks.first), 2 * (b.f_error + 1e-12 * exact.value));
      EXPECT_LE(std::fabs(marks.second - exact_marks.second), 4 * (b.f_error + 1e-12 * exact.value));
      EXPECT_LE(length(marks.second_gradient - exact_marks.second_gradient), 4e4 * b.steepest * (1e-11 + error));
      fullest = std::max(fullest, f_off / (b.f_error + 1e-12 * exact.value));
      // One and two derivatives more: by a degree less each.
      const double reach = 0.5 * length(g.box.size());
      steep_worst = std::max(steep_worst, length(told.gradient - exact.gradient) / (b.steepest * (1e-11 + error)));
      bent_worst = std::max(bent_worst, norm(difference(told.si_jacobian, exact.si_jacobian)) /
                                            ((b.S_longest / reach + b.S_second * reach) * (1e-11 + error)));
    }
  }
  std::cout << "  " << gathered << " sources; of the stated error at most " << fullest << '\n';
  EXPECT_GT(gathered, 20000U);
  EXPECT_GT(fullest, 0.02) << "errors say little";
  EXPECT_LT(steep_worst, 1e4);
  EXPECT_LT(bent_worst, 1e4);
}

TEST(FarPolynomial, BoundsHold) {
  Random random(20261102);
  double closest = 0;
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Gathered g = gather(random, random.whole(2, 12), round % 2 == 0, 1e-3);
    if (g.sums.empty()) continue;
    const FarPolynomial::Bounds& b = g.far->bounds();
    for (int i = 0; i < 10; ++i) {
      const Vec3d p = point_in(g.box, random), q = point_in(g.box, random);
      const double apart = length(p - q);
      const SkeletonSample at_p = g.far->at(p), at_q = g.far->at(q);
      EXPECT_LE(length(at_p.gradient), b.steepest);
      EXPECT_LE(length(at_p.si_gradient), b.S_longest);
      EXPECT_LE(length(at_p.gradient - at_q.gradient), b.second * apart * (1 + 1e-9) + 1e-12 * b.steepest);
      const Vec3d v = direction(random);
      const Vec3d turned = at_p.si_jacobian.times(v) - at_q.si_jacobian.times(v);
      EXPECT_LE(length(turned), b.S_second * apart * (1 + 1e-9) + 1e-11 * norm(at_p.si_jacobian));
      closest = std::max(closest, length(at_p.gradient) / b.steepest);
    }
  }
  EXPECT_GT(closest, 0.3) << "bounds say little";
}

TEST(FarPolynomial, MovesToBoxesInside) {
  Random random(20261103);
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const int exponent = random.whole(2, 10);
    const Gathered outer = gather(random, exponent, false, 1e-6);
    const Gathered inner = gather(random, exponent, false, 1e-6, outer.far.get(), &outer.box);
    EXPECT_GE(inner.far->bounds().f_error, outer.far->bounds().f_error);
    const Vec3d p = point_in(inner.box, random);
    SkeletonSample expected = outer.far->at(p);
    const SkeletonSample told = inner.far->at(p), own = inner.sums.at(p).sum;
    EXPECT_NEAR(told.value, expected.value + own.value, inner.allowed + 1e-12 * told.value);
    EXPECT_LE(length(told.si_gradient - expected.si_gradient - own.si_gradient),
              inner.far->bounds().S_error + 1e-12 * inner.far->bounds().S_longest);
  }
}

// Column by column in plain doubles: no instruction set may give other bits.
TEST(FarPolynomial, IsTheSumOfItsColumnsBitForBit) {
  Random random(20261104);
  constexpr int degree = FarPolynomial::degree;
  for (int round = 0; round < 50; ++round) {
    FarPolynomial::Coefficients f, h;
    for (double& c : f) c = random.between(-1, 1);
    for (double& c : h) c = random.between(-1, 1);
    const FarPolynomial far({0, 0, 0}, 1, f, h, {});
    const Vec3d p = random.vector(0.5);
    double x_to[degree + 1], y_to[degree + 1];
    x_to[0] = y_to[0] = 1;
    for (int i = 0; i < degree; ++i) {
      x_to[i + 1] = x_to[i] * p.x;
      y_to[i + 1] = y_to[i] * p.y;
    }
    double value[4]{}, along_z[4]{};
    for (int sum = 0; sum <= degree; ++sum)
      for (int i = 0; i <= sum; ++i) {
        const auto column = [&](const FarPolynomial::Coefficients& of, double& slope) {
          double v = 0;
          slope = 0;
          for (int k = degree - sum; k >= 0; --k) {
            slope = slope * p.z + v;
            v = v * p.z + of[monomial_index(i, sum - i, k)];
          }
          return v;
        };
        double slope = 0;
        value[i % 4] += column(f, slope) * (x_to[i] * y_to[sum - i]);
        column(h, slope);
        along_z[i % 4] += slope * (x_to[i] * y_to[sum - i]);
      }
    EXPECT_EQ(far.value_at(p).value, value[0] + value[1] + value[2] + value[3]);
    EXPECT_EQ(far.at(p).si_gradient.z, along_z[0] + along_z[1] + along_z[2] + along_z[3]);
  }
}

}  // namespace
}  // namespace marrow
