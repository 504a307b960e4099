// Laws of the inverse family, of quadrature and of the power integrals.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "field/kernel/inverse_family.h"
#include "field/kernel/power_integrals.h"
#include "field/kernel/segment_moments.h"
#include "field/math/elementary.h"
#include "field/math/gauss_rule.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;
using test::relative;

TEST(GaussRule, IsExactForPolynomials) {
  constexpr auto& rule = gauss_rule<12>;
  for (int power = 0; power < 24; ++power) {
    double integral = 0;
    for (std::size_t i = 0; i < 12; ++i) integral += rule.weights[i] * integer_power(rule.nodes[i], power);
    EXPECT_NEAR(integral, 1.0 / (power + 1), 2e-16 * 4) << power;
  }
}

TEST(Root, IsTheRootOfAWholeDegree) {
  Random random(53);
  for (int degree = 1; degree <= 21; ++degree)
    for (int i = 0; i < 2000; ++i) {
      const double x = std::exp2(random.between(-1, 1) * (i % 2 == 0 ? 996 : 8));
      const long double expected = std::pow(static_cast<long double>(x), 1.0L / degree);
      EXPECT_LE(std::fabs(static_cast<double>(root(x, degree) / expected - 1)), 3 * 0x1p-52) << x << ' ' << degree;
    }
  EXPECT_EQ(root(0, 5), 0);
  EXPECT_EQ(root(1, 21), 1);
}

TEST(InverseFamily, NormalisationIsTheGammaQuotient) {
  for (int n = min_kernel_degree; n <= max_kernel_degree; ++n) {
    const double expected = std::sqrt(std::numbers::pi) * tgamma((n - 1) / 2.0) / tgamma(n / 2.0);
    EXPECT_LE(relative(curve_normalisation(n), expected), 1e-14) << n;
  }
}

TEST(ReferenceCurve, HasItsInverseAndItsSlope) {
  Random random(1);
  for (int n = min_kernel_degree; n <= max_kernel_degree; ++n) {
    const ReferenceCurve curve(n);
    for (int i = 0; i < 50; ++i) {
      const double f = exp(random.between(-12, 6)), h = f * 1e-5;
      EXPECT_LE(relative(curve.inverse(curve.at(f)), f), 1e-14);
      EXPECT_LE(relative((curve.at(f + h) - curve.at(f - h)) / (2 * h), curve.slope(f)), 1e-8);
    }
  }
}

TEST(PowerIntegrals, AgreeWithQuadrature) {
  constexpr auto& rule = gauss_rule<20>;
  Random random(2);
  for (int i = 0; i < 60; ++i) {
    const double t1 = -random.between(0.2, 1), t2 = random.between(0.2, 1), h2 = random.between(0.4, 1);
    for (const int max_m : {8, 9}) {
      const int n = max_m - 4, power = random.whole(0, n);
      const PowerIntegrals J(t1, t2, h2, max_m, n, power);
      EXPECT_EQ(J.j_of(n + 4), power + 2);
      for (int m = n; m <= max_m; m += 2)
        for (int j = 0; j <= std::min(m, J.j_of(m)); ++j) {
          double integral = 0;
          for (int panel = 0; panel < 8; ++panel)
            for (std::size_t k = 0; k < 20; ++k) {
              const double t = t1 + (t2 - t1) * (panel + rule.nodes[k]) / 8;
              const double term = rule.weights[k] * (t2 - t1) / 8 * integer_power(t, j) * pow(t * t + h2, -m / 2.0);
              integral += term;
            }
          // High powers come from low ones by differences, so their error is that of h^j J(0, m).
          EXPECT_NEAR(J(j, m), integral, 3e-13 * pow(h2, j / 2.0) * J(0, m)) << "j " << j << " m " << m;
        }
    }
  }
}

void expect_equal(const SegmentMoments& a, const SegmentMoments& b, double extent, double tolerance) {
  EXPECT_LE(relative(a.value, b.value), tolerance);
  for (int j = 0; j < 2; ++j) {
    const double unit = j == 0 ? 1 : extent;
    EXPECT_NEAR(a.first[j], b.first[j], tolerance * unit * a.first[0]);
    EXPECT_NEAR(a.si[j], b.si[j], tolerance * unit * a.si[0]);
  }
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(a.second[j], b.second[j], tolerance * integer_power(extent, j) * a.second[0]);
}

TEST(SegmentMoments, ClosedFormAndPanelsAgreeWhereTheFootIsInside) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    SegmentView view{};
    view.t1 = -random.between(0.01, 1);
    view.t2 = random.between(0.01, 1);
    const double height = view.length() * exp(random.between(-9, -0.3));
    view.h_squared = height * height;
    view.radius1 = random.between(0.05, 1);
    view.slope = random.between(-0.9, 0.9) * view.radius1 / view.length();
    view.radius_at_foot = view.radius1 - view.slope * view.t1;
    const int n = random.whole(3, 8);
    expect_equal(segment_moments_by_recurrence<Derivatives::Second>(view, n),
                 segment_moments_by_panels<Derivatives::Second>(view, n), std::min(height, view.length()), 2e-12);
  }
}

}  // namespace
}  // namespace marrow
