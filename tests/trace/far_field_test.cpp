// Far fields: polynomials near enough to what they stand for, the same function for a child, and bounded.
#include "field/trace/sources/far_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "field/math/taylor_remainder.h"
#include "field/skeleton/skeletons.h"
#include "field/trace/levels/level_polynomials.h"
#include "field/trace/sources/kept_far_field.h"
#include "tests/trace/far_value.h"
#include "tests/trace/stage.h"

namespace marrow::test {
namespace {

TEST(FarField, TaylorRemainderIsTheTailOfTheSeries) {
  for (int m = 2; m <= 8; ++m)
    for (int degree = 0; degree <= 7; ++degree)
      for (double q = 0.05; q < 0.95; q += 0.05) {
        long double head = 0, term = 1;
        for (int k = 0; k <= degree; term *= static_cast<long double>(q) * (m + k) / (k + 1), ++k) head += term;
        const auto tail = static_cast<double>(1 / std::pow(1 - static_cast<long double>(q), m) - head);
        const double bound = taylor_remainder(m, degree, q);
        EXPECT_GE(bound, tail * (1 - 1e-9) - 1e-15) << m << ' ' << degree << ' ' << q;
        EXPECT_LE(bound, tail * 1.01 + 1e-12) << m << ' ' << degree << ' ' << q;
      }
}

TEST(FarField, MonomialsKnowTheirPlaces) {
  for (std::size_t i = 0; i < monomial_count; ++i) {
    EXPECT_EQ(monomial_index(monomials[i].a, monomials[i].b, monomials[i].c), i);
    EXPECT_TRUE(i == 0 || monomials[i - 1].degree() <= monomials[i].degree());
  }
}

struct Split {
  BlendField blend;
  std::vector<Piece> far_pieces;
  Vec3d center;
  double half;
  FarField far;
};

int far_degree(int round) {
  constexpr int degrees[] = {high_far_degree, low_far_degree, highest_far_degree};
  return degrees[round % 3];
}

// A random blend seen from a small cube, with the budget of the fine level or a hundred times that.
Split random_split(Random& random, int degree, double tolerance, int far_degree) {
  Split s{.blend = random_scene(random, {.degree = degree}, 12),
          .far_pieces = {},
          .center = random.vector(2),
          .half = exp(random.between(-4, -0.7)),
          .far = {}};
  const auto pieces = PieceCutter(degree, 2.0).cut(s.blend);
  std::vector<PieceIndex> all(pieces.size());
  std::iota(all.begin(), all.end(), PieceIndex{0});
  const NearFar near_far(degree, budget_of(tolerance, degree), *block_kernels(""), far_degree);
  const auto near = near_far.split(pieces, all, s.center, s.half, s.far);
  for (const PieceIndex i : all)
    if (std::find(near.begin(), near.end(), i) == near.end()) s.far_pieces.push_back(pieces[i]);
  return s;
}

FarValue exact_far(const Split& s, const Vec3d& p) {
  SkeletonSample sum;
  for (const Piece& piece : s.far_pieces)
    sum += piece.is_point() ? point_field<Derivatives::ScaleInvariant>({piece.from, piece.radius}, p, s.blend.degree)
                            : segment_field<Derivatives::ScaleInvariant>(
                                  {piece.from, piece.to, piece.radius_from, piece.radius_to}, p, s.blend.degree);
  return {sum.value, sum.si_gradient};
}

TEST(FarField, IsWithinItsStatedErrorOverTheCube) {
  Random random(41);
  double f_use = 0, g_use = 0;
  std::size_t far_pieces = 0;
  for (int i = 0; i < 600; ++i) {
    const int n = random.whole(3, 7);
    const Split s = random_split(random, n, i % 2 ? 1e-5 : 1e-3, far_degree(i / 2));
    far_pieces += s.far_pieces.size();
    for (int k = 0; k < 20; ++k) {
      Vec3d x = random.vector(1);
      if (k % 4 == 0) x = x / max_component(abs(x));  // on a face
      const FarValue exact = exact_far(s, s.center + x * s.half), found = value_of(s.far, x);
      const double f_error = std::fabs(found.f - exact.f), g_error = length(found.g - exact.g);
      // Moments are sums in float: some 1e-6 of the sum of norms.
      const double rounding = 2e-6 * exact.f;
      ASSERT_LE(f_error, s.far.f_error + rounding) << "n=" << n;
      ASSERT_LE(g_error, s.far.gradient_error + 2 * n * rounding) << "n=" << n;
      if (s.far.f_error > 0) f_use = std::max(f_use, f_error / s.far.f_error);
      if (s.far.gradient_error > 0) g_use = std::max(g_use, g_error / s.far.gradient_error);
    }
  }
  std::cout << "  " << far_pieces << " far pieces; largest error over bound: f " << f_use << ", grad_S f " << g_use
            << '\n';
  EXPECT_GT(far_pieces, 2000U);
}

TEST(FarField, OfAChildIsTheSameFunction) {
  Random random(42);
  for (int i = 0; i < 100; ++i) {
    const Split s = random_split(random, random.whole(3, 7), 1e-3, far_degree(i));
    for (int octant = 0; octant < 8; ++octant) {
      const FarField child = s.far.of_child(octant);
      EXPECT_EQ(child.f_error, s.far.f_error);
      EXPECT_EQ(child.gradient_error, s.far.gradient_error);
      const Vec3d x = random.vector(1), shift = octant_center({0, 0, 0}, 1, octant);
      const FarValue a = value_of(child, x), b = value_of(s.far, shift + x * 0.5);
      EXPECT_NEAR(a.f, b.f, 1e-12 * (1 + b.f));
      EXPECT_LT(length(a.g - b.g), 1e-12 * (1 + length(b.g)));
    }
  }
}

TEST(FarField, KeptItSaysByHowMuchItIsOff) {
  Random random(46);
  double f_use = 0, g_use = 0, f_rise = 0;
  for (int i = 0; i < 100; ++i) {
    const int degree = far_degree(i);
    const Split s = random_split(random, random.whole(3, 7), 1e-3, degree);
    const KeptFarField kept(s.far);
    const FarField whole = kept.whole();
    ASSERT_EQ(whole.degree, s.far.degree);
    EXPECT_EQ(kept.bytes(), 4 * (monomials_to_degree(whole.degree) + monomials_to_degree(whole.degree + 1)));
    const double f_rounding = whole.f_error - s.far.f_error, g_rounding = whole.gradient_error - s.far.gradient_error;
    for (int k = 0; k < 20; ++k) {
      const Vec3d x = random.vector(1);
      const FarValue a = value_of(s.far, x), b = value_of(whole, x);
      ASSERT_LE(std::fabs(a.f - b.f), f_rounding + 1e-15 * (1 + a.f));
      ASSERT_LE(length(a.g - b.g), g_rounding + 1e-14 * (1 + length(a.g)));
      if (f_rounding > 0) f_use = std::max(f_use, std::fabs(a.f - b.f) / f_rounding);
      if (g_rounding > 0) g_use = std::max(g_use, length(a.g - b.g) / g_rounding);
    }
    const FarField::Bounds b = s.far.bounds();
    f_rise = std::max(f_rise, f_rounding / (b.f_center + b.f_variation));
  }
  std::cout << "  largest difference over what is stated: f " << f_use << ", grad_S f " << g_use
            << "; largest rise of the error of f over f: " << f_rise << '\n';
  EXPECT_GT(f_use, 0.1);
  EXPECT_LT(f_rise, 0x1p-24);
}

TEST(FarField, BoundsContainTheField) {
  Random random(43);
  for (int i = 0; i < 300; ++i) {
    const Split s = random_split(random, random.whole(3, 7), 1e-3, far_degree(i));
    const FarField::Bounds b = s.far.bounds();
    for (int k = 0; k < 20; ++k) {
      const Vec3d x = random.vector(1);
      const FarValue polynomial = value_of(s.far, x), exact = exact_far(s, s.center + x * s.half);
      for (const FarValue& v : {polynomial, exact}) {
        EXPECT_LE(std::fabs(v.f - b.f_center), b.f_variation + 2e-6 * exact.f);
        EXPECT_LE(length(v.g - b.gradient_center), b.gradient_variation + 4e-5 * exact.f);
      }
    }
  }
}

FarValue level_value(const LevelPolynomials& far, const Vec3d& x) {
  FarValue v;
  for (std::size_t i = 0; i < far.coefficients.size(); ++i) {
    const Monomial& m = monomials[i];
    const double power = integer_power(x.x, m.a) * integer_power(x.y, m.b) * integer_power(x.z, m.c);
    v.f += far.coefficients[i][0] * power;
    v.g += Vec3d{far.coefficients[i][1], far.coefficients[i][2], far.coefficients[i][3]} * power;
  }
  return v;
}

// What leaving out monomials would cost.
double truncation_error(const FarField& far, int degree) {
  double sum = 0;
  for (std::size_t i = monomials_to_degree(degree); i < monomials_to_degree(far.degree); ++i)
    sum += std::fabs(far.f[i]);
  return sum;
}

TEST(FarField, OfALowerDegreeIsWithinItsStatedError) {
  Random random(44);
  double use = 0, saved = 1;
  for (int i = 0; i < 300; ++i) {
    const Split s = random_split(random, random.whole(3, 7), 1e-5, far_degree(i));
    if (s.far_pieces.empty()) continue;
    const int degree = s.far.degree == low_far_degree ? 2 : evaluated_degrees[static_cast<std::size_t>(i / 3 % 3)];
    const LevelPolynomials low = economized(s.far, {.most = degree});
    ASSERT_EQ(low.coefficients.size(), monomials_to_degree(degree));
    const double f_allowed = low.f_error - s.far.f_error, g_allowed = low.gradient_error - s.far.gradient_error;
    for (int k = 0; k < 40; ++k) {
      Vec3d x = random.vector(1);
      if (k % 2 == 0) x = x / max_component(abs(x));  // on a face
      const FarValue whole = value_of(s.far, x), part = level_value(low, x);
      ASSERT_LE(std::fabs(whole.f - part.f), f_allowed + 1e-14 * whole.f);
      ASSERT_LE(length(whole.g - part.g), g_allowed + 1e-13 * (whole.f + length(whole.g)));
      if (f_allowed > 0) use = std::max(use, std::fabs(whole.f - part.f) / f_allowed);
    }
    saved = std::min(saved, f_allowed / truncation_error(s.far, degree));
  }
  std::cout << "  largest difference over what is stated " << use << ", that over a truncation's at best " << saved
            << '\n';
  EXPECT_GT(use, 0.3);
  EXPECT_LT(saved, 0.25);
}

TEST(FarField, TakesTheLowestDegreeThatIsWithinTheEconomy) {
  Random random(45);
  std::array<int, evaluated_degrees.size()> taken{};
  for (int i = 0; i < 300; ++i) {
    const Split s = random_split(random, random.whole(3, 7), 1e-5, i % 2 ? high_far_degree : highest_far_degree);
    if (s.far_pieces.empty()) continue;
    const Economy allowed{
        .most = evaluated_degrees.back(), .f = exp(random.between(-16, -4)), .gradient = exp(random.between(-14, -2))};
    const auto is_within = [&](int degree) {
      const LevelPolynomials all = economized(s.far, {.most = degree});
      return all.f_error - s.far.f_error <= allowed.f && all.gradient_error - s.far.gradient_error <= allowed.gradient;
    };
    std::size_t expected = 0;
    while (expected + 1 < evaluated_degrees.size() && !is_within(evaluated_degrees[expected])) ++expected;
    const LevelPolynomials found = economized(s.far, allowed);
    ASSERT_EQ(found.degree, evaluated_degrees[expected]);
    ASSERT_EQ(found.coefficients, economized(s.far, {.most = found.degree}).coefficients);
    ++taken[expected];
  }
  for (const int times : taken) EXPECT_GT(times, 10);
}

}  // namespace
}  // namespace marrow::test
