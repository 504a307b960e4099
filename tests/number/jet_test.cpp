// Formulas of every function keep the laws of fields: their derivatives and enclosures belong to their values.
#include <numbers>

#include <gtest/gtest.h>

#include "tests/tree/laws.h"

namespace marrow::test {
namespace {

/// f(x, y, z) as a field.
template <class Formula>
struct FieldOf {
  Formula formula;
  template <Number X>
  X value(const Vec3<X>& p) const {
    return formula(p.x, p.y, p.z);
  }
};

template <class Formula>
void expect_lawful(const char* name, const Formula& formula, std::uint64_t most_rough) {
  SCOPED_TRACE(name);
  const FieldOf<Formula> field{formula};
  const Box3 region{{-2, -2, -2}, {2, 2, 2}};
  Random random(21);
  Checks checks;
  for (int i = 0; i < 400 && !testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("round " + std::to_string(i));
    expect_enclosures(field, random_box(point_in(region, random), random), 5, random, checks);
    expect_ray_enclosures(field, point_in(region, random), 3, random, checks);
    const Vec3d p = point_in(region, random);
    expect_gradient(field, p, checks);
    expect_hessian(field, p, checks);
  }
  EXPECT_LE(checks.rough_slopes, most_rough);
  EXPECT_LE(checks.rough_curvatures, most_rough);
}

TEST(Jet, Arithmetic) {
  expect_lawful(
      "sum and product", [](auto x, auto y, auto z) { return x * y - z * x + y * y * z; }, 0);
  using std::numbers::e;
  expect_lawful(
      "quotient", []<class X>(X x, X y, X z) { return (x - y * z) / (X(e) + x * x); }, 0);
  expect_lawful(
      "in place",
      []<class X>(X x, X y, X z) {
        x *= y;
        x += z;
        x -= X(0.5) * y;
        return -x;
      },
      0);
  expect_lawful(
      "with constants",
      [](auto x, auto y, auto z) { return 2.5 * x - (y * -1.5 + 0.25) * (3.0 - z) + (x - 1.0) * (0.5 + y); }, 0);
  expect_lawful(
      "with constant vectors",
      []<class X>(X x, X y, X z) {
        const Vec3<X> v = Vec3<X>{x, y, z} - Vec3d{1, -2, 0.3};
        return dot(v, Vec3d{0.1, 0.7, -3}) * v.x;
      },
      0);
}

TEST(Jet, SmoothFunctions) {
  expect_lawful(
      "square", [](auto x, auto y, auto z) { return square(x - y) * z; }, 0);
  expect_lawful(
      "sqrt", []<class X>(X x, X y, X z) { return sqrt(X(0.3) + square(x) + square(y)) * z; }, 0);
  expect_lawful(
      "integer_power",
      [](auto x, auto y, auto z) {
        return integer_power(x, 0) + integer_power(y, 1) + integer_power(z, 2) + integer_power(x, 3) +
               integer_power(y, 7);
      },
      20);
  expect_lawful(
      "pow",
      []<class X>(X x, X y, X z) {
        return pow(X(6.0) + x, 2.5) + pow(X(6.0) + y, -0.5) + pow(X(6.0) + z, 1) + pow(X(6.0) + x, 0);
      },
      0);
  expect_lawful(
      "exp", [](auto x, auto y, auto z) { return exp(x * y) * z; }, 0);
  expect_lawful(
      "log", []<class X>(X x, X y, X z) { return log(X(6.0) + x) * y + z; }, 0);
  expect_lawful(
      "sincos",
      [](auto x, auto y, auto z) {
        const auto [sine, cosine] = sincos(x * y);
        return sine * z + cosine;
      },
      0);
  expect_lawful(
      "asin", [](auto x, auto y, auto z) { return asin(0.9 * sin(x * y)) * z; }, 0);
  expect_lawful(
      "sin and cos", [](auto x, auto y, auto z) { return sin(x * y) * cos(z + y); }, 0);
  expect_lawful(
      "atan", [](auto x, auto y, auto z) { return atan(x * y) + atan(z); }, 0);
}

TEST(Jet, FunctionsWithKinks) {
  expect_lawful(
      "max", [](auto x, auto y, auto z) { return max(x * y, z); }, 20);
  expect_lawful(
      "min", [](auto x, auto y, auto z) { return min(x * y, square(z)); }, 20);
  expect_lawful(
      "abs", [](auto x, auto y, auto z) { return abs(x) * abs(y) + z; }, 20);
  expect_lawful(
      "clamp", [](auto x, auto y, auto z) { return clamp(x + y, -1, 0.5) * z; }, 20);
  expect_lawful(
      "piecewise",
      []<class X>(X x, X y, X z) {
        return piecewise(
            x, 0.25, [&](const X& l) { return square(l) * y; },
            [&](const X& r) { return (X(0.5) * r - X(0.0625)) * y + (r - X(0.25)) * z; });
      },
      20);
  expect_lawful(
      "length", [](auto x, auto y, auto z) { return length(x, y) + z; }, 20);
  expect_lawful(
      "length of three",
      []<class X>(X x, X y, X z) {
        return length(Vec3<X>{x, y, z});
      },
      20);
}

// Points exactly at kinks have the slope of one side, and enclosures those of both.
TEST(Jet, EnclosuresAtKinksHoldBothSides) {
  const SlopeBounds below = SlopeBounds::variable({-1, 0}, 0), above = SlopeBounds::variable({0, 1}, 0);
  for (const SlopeBounds& x : {below, above}) {
    EXPECT_EQ(abs(x).slope[0], Interval(-1, 1));
    EXPECT_EQ(clamp(x, 0, 5).slope[0], Interval(0, 1));
  }
  const SlopeBounds at_origin = length(SlopeBounds::variable(0.0, 0), SlopeBounds::variable(0.0, 1));
  EXPECT_TRUE(at_origin.slope[0].contains(Interval(-1, 1)));
  EXPECT_TRUE(std::isfinite(at_origin.slope[0].width()));
  EXPECT_EQ(length(Gradient::variable(0.0, 0), Gradient::variable(0.0, 1)).slope[0], 0);
}

// So that where a field has ended nothing of it is left, not even bounds of rounding.
TEST(Jet, KnownRangesTightenEnclosuresOnly) {
  EXPECT_EQ(known_within(Interval(-1e-40, 1), 0, 2), Interval(0, 1));
  EXPECT_EQ(known_within(-3.0, 0, 2), -3.0);
  const SlopeBounds x = known_within(SlopeBounds::variable({-1, 5}, 0), 0, 2);
  EXPECT_EQ(x.value, Interval(0, 2));
  EXPECT_EQ(x.slope[0], Interval(1));
}

}  // namespace
}  // namespace marrow::test
