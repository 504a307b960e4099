// Gauss-Legendre rules are exact for polynomials, and their error for a piece of skeleton is bounded.
#include "field/trace/sources/quadrature.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "field/skeleton/shares.h"
#include "field/skeleton/skeletons.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

TEST(Quadrature, IsExactForPolynomials) {
  for (int count = 1; count <= max_gauss_nodes; ++count) {
    const GaussNodes rule = gauss_legendre(count);
    ASSERT_EQ(rule.positions.size(), static_cast<std::size_t>(count));
    for (int power = 0; power < 2 * count; ++power) {
      double sum = 0;
      for (std::size_t i = 0; i < rule.positions.size(); ++i)
        sum += rule.weights[i] * integer_power(rule.positions[i], power);
      EXPECT_NEAR(sum, 1.0 / (power + 1), 1e-15) << count << " nodes, power " << power;
    }
  }
}

struct PieceCase {
  SegmentSkeleton piece;
  Vec3d p;
  int degree;
  double length, distance;

  double mass() const {
    return length * integer_power(std::max(piece.radius_from, piece.radius_to), degree - 1) /
           curve_normalisation(degree);
  }
  PieceCase part(double begin, double end) const {
    PieceCase c = *this;
    c.piece = {.from = lerp(piece.from, piece.to, begin),
               .to = lerp(piece.from, piece.to, end),
               .radius_from = std::lerp(piece.radius_from, piece.radius_to, begin),
               .radius_to = std::lerp(piece.radius_from, piece.radius_to, end)};
    c.length = length * (end - begin);
    return c;
  }
};

// A segment of length up to 1.5 of its radius, and a point 0.2 to 10 lengths away from it in any direction.
PieceCase random_piece(Random& random, int degree) {
  PieceCase c{.piece = {}, .p = {}, .degree = degree, .length = exp(random.between(-3, 0.4)), .distance = 0};
  c.piece.from = random.vector(1);
  c.piece.to = c.piece.from + random_direction(random) * c.length;
  c.piece.radius_from = 1;
  c.piece.radius_to = random.between(0, 1) < 0.3 ? 1 : exp(random.between(-3, 0));
  if (random.between(0, 1) < 0.5) std::swap(c.piece.radius_from, c.piece.radius_to);
  c.distance = c.length * exp(random.between(-1.6, 2.3));
  const Vec3d axis = (c.piece.to - c.piece.from) / c.length, out = random_direction(random);
  const Vec3d end = dot(out, axis) > 0 ? c.piece.to : c.piece.from;
  if (random.between(0, 1) < 0.6) {
    c.p = end + out * c.distance;
  } else {
    const Vec3d across = normalize(cross(axis, out));
    c.p = lerp(c.piece.from, c.piece.to, random.between(0, 1)) + across * c.distance;
  }
  return c;
}

struct Sums {
  double f = 0;
  Vec3d g{};

  Sums& operator+=(const Sums& more) {
    f += more.f;
    g += more.g;
    return *this;
  }
};

// With weights that are linear from one end to the other.
Sums by_rule(const PieceCase& c, int nodes, double at_from = 1, double at_to = 1) {
  const GaussNodes rule = gauss_legendre(nodes);
  const int n = c.degree;
  Sums s;
  for (std::size_t i = 0; i < rule.positions.size(); ++i) {
    const Vec3d v = c.p - lerp(c.piece.from, c.piece.to, rule.positions[i]);
    const double radius = c.piece.radius_from + (c.piece.radius_to - c.piece.radius_from) * rule.positions[i];
    const double d = length(v), weight = std::lerp(at_from, at_to, rule.positions[i]);
    const double w = weight * rule.weights[i] * c.length / curve_normalisation(n);
    s.f += w * integer_power(radius, n - 1) / integer_power(d, n);
    s.g += v * (-n * w * integer_power(radius, n) / integer_power(d, n + 2));
  }
  return s;
}

TEST(Quadrature, BoundHoldsForAnyPieceAndPlace) {
  Random random(11);
  std::vector<double> tightness;  // true error over bound, where the error is above rounding
  for (int i = 0; i < 40000; ++i) {
    const int degree = random.whole(3, 7), nodes = random.whole(1, max_gauss_nodes);
    const PieceCase c = random_piece(random, degree);
    const double slope = std::fabs(c.piece.radius_to - c.piece.radius_from) / c.length;
    const double radius = std::max(c.piece.radius_from, c.piece.radius_to);
    const auto bound = GaussError(degree).bound(nodes, {c.mass(), radius, slope, c.length}, c.distance * (1 - 1e-12));
    const SkeletonSample exact = segment_field<Derivatives::ScaleInvariant>(c.piece, c.p, degree);
    const Sums sums = by_rule(c, nodes);
    const double f_error = std::fabs(sums.f - exact.value), g_error = length(sums.g - exact.si_gradient);
    const double f_rounding = 1e-12 * exact.value, g_rounding = 1e-12 * degree * exact.value * radius / c.distance;
    ASSERT_LE(f_error, bound.field + f_rounding) << "case " << i << " n=" << degree << " nodes " << nodes;
    ASSERT_LE(g_error, bound.gradient + g_rounding) << "case " << i << " n=" << degree << " nodes " << nodes;
    if (f_error > 10 * f_rounding) tightness.push_back(f_error / bound.field);
  }
  ASSERT_GT(tightness.size(), 10000U);
  std::sort(tightness.begin(), tightness.end());
  std::cout << "  error / bound: largest " << tightness.back() << ", median " << tightness[tightness.size() / 2]
            << ", of " << tightness.size() << '\n';
  EXPECT_GT(tightness.back(), 0.05) << "the bound serves nobody";
}

// A field whose sources count linearly more towards one end: of it the closed forms tell f, finer rules the vector.
TEST(Quadrature, BoundHoldsForAnyLinearWeight) {
  Random random(103);
  double tightest = 0;
  for (int i = 0; i < 20000; ++i) {
    const int degree = random.whole(3, 7), nodes = random.whole(1, max_gauss_nodes);
    const PieceCase c = random_piece(random, degree);
    const double slope = std::fabs(c.piece.radius_to - c.piece.radius_from) / c.length;
    const double radius = std::max(c.piece.radius_from, c.piece.radius_to);
    const double least = random.between(0, 1) < 0.3 ? 0 : random.between(0, 1);
    const bool rises = random.between(0, 1) < 0.5;
    const double from = rises ? least : 1, to = rises ? 1 : least;
    const auto bound =
        GaussError(degree).bound(nodes, {c.mass(), radius, slope, c.length, to - from}, c.distance * (1 - 1e-12));
    const double f = segment_field<Derivatives::First>(c.piece, c.p, degree).value;
    const double exact = from * f + (to - from) * segment_share(c.piece, c.p, {.degree = degree}).value;
    const Sums sums = by_rule(c, nodes, from, to);
    EXPECT_LE(std::fabs(sums.f - exact), bound.field + 1e-12 * f) << "case " << i << " n=" << degree;
    if (bound.field > 1e-10 * f) tightest = std::max(tightest, std::fabs(sums.f - exact) / bound.field);
    Sums fine;
    for (int k = 0; k < 64; ++k)
      fine += by_rule(c.part(k / 64.0, (k + 1) / 64.0), max_gauss_nodes, std::lerp(from, to, k / 64.0),
                      std::lerp(from, to, (k + 1) / 64.0));
    EXPECT_LE(length(sums.g - fine.g), bound.gradient + 1e-11 * degree * f * radius / c.distance) << "case " << i;
  }
  std::cout << "  error / bound: largest " << tightest << '\n';
  EXPECT_GT(tightest, 0.05) << "the bound serves nobody";
}

// A piece of two radii at the distance of its radius: the series of derivatives would not do with 12 nodes.
TEST(Quadrature, CloseToAPieceRulesConvergeAsEllipsesSay) {
  const GaussError errors(4);
  double before = 1;
  for (int nodes = 4; nodes <= max_gauss_nodes; ++nodes) {
    const double error = errors.bound(nodes, {1, 1, 0, 2}, 1).field;
    // Poles beside the middle, at i: the ellipse through them has semiaxes that add up to 1 + sqrt(2).
    EXPECT_LT(error, before / 4.5) << nodes;
    before = error;
  }
  const auto rule = errors.smallest_rule({1, 1, 0, 2}, 1, {1e-7, 4e-7});
  EXPECT_TRUE(rule.within);
  EXPECT_LE(rule.nodes, 12);
}

}  // namespace
}  // namespace marrow::test
