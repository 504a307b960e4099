// Bounds of the partial derivatives of the operator of the Cauchy and the compact kernel hold those derivatives, and
// come near them where intervals are short.
#include "field/blend/bounds/correction/bounded_partials.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "field/blend/bounds/correction/curve_bounds.h"
#include "tests/field/partials_check.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::expect_holds;
using test::expect_holds_difference;
using test::Random;
using test::text;
using test::within;

constexpr double half_pi = std::numbers::pi / 2;

// Also shapes whose own surface lies beyond the top.
Kernel random_kernel(Random& random, int i) {
  const int n = random.whole(3, 9);
  return i % 2 == 0 ? Kernel{KernelFamily::Cauchy, n, random.between(0.3, 3)}
                    : Kernel{KernelFamily::Compact, n, random.between(1.1, 4)};
}

Interval around(Random& random, double x, double width) { return {x, x * (1 + width * random.between(0, 1))}; }

// One setting of the operator and ranges of what it is applied to.
struct Setting {
  Kernel kernel;
  bool cavity;
  Projection projection;
  Interval alpha, f, G;

  Correction at(double angle) const { return Correction(kernel, angle, cavity, projection); }
  Interval value() const {
    const Correction least = at(alpha.lo), most = at(alpha.hi);
    if (cavity && alpha.lo < alpha.hi) return correction_bounds_between(*least.bounded(), *most.bounded(), f, G);
    return hull(correction_bounds(least, f, G), correction_bounds(most, f, G));
  }
  PartialBounds bounds() const { return bounded_partials(at(alpha.lo), alpha, value(), f, G); }
};

// A third each: anywhere; about the curve; about the top.
Setting random_setting(Random& random, int i, double width) {
  Setting s{.kernel = random_kernel(random, i),
            .cavity = i % 4 < 2,
            .projection = i % 8 < 4 ? Projection::Paper : Projection::Exact,
            .alpha = {},
            .f = {},
            .G = {}};
  const BoundedCurve curve(s.kernel);
  const double top = curve.top_field(), near = std::fabs(1 + random.between(-2, 1) * width);
  double f = std::min(curve.largest_field(), 4 * top) * std::pow(random.between(0, 1), 2);
  if (i % 3 == 2) f = top * near;
  const double G = curve.at(f) * (i % 3 == 0 ? random.between(0, 1.3) : near);
  const double a = i % 16 < 2 ? 0 : random.between(0, half_pi);
  const double b = i % 5 < 3 ? a : i % 5 == 3 ? random.between(0, half_pi) : std::min(half_pi, a + width);
  s.alpha = {std::min(a, b), std::max(a, b)};
  s.f = around(random, f, width);
  s.G = around(random, G, width);
  return s;
}

std::string text(const Setting& s) {
  return (s.kernel.family == KernelFamily::Cauchy ? "Cauchy " : "compact ") + std::to_string(s.kernel.degree) +
         " shape " + std::to_string(s.kernel.shape) + (s.cavity ? " cavity" : "") +
         (s.projection == Projection::Exact ? " exact" : " chord") + " alpha " + text(s.alpha) + " f " + text(s.f) +
         " G " + text(s.G);
}

TEST(BoundedPartials, HoldThePartialsOfEveryPlace) {
  Random random(20261122);
  int behind = 0;
  for (int i = 0; i < 100'000 && !HasFailure(); ++i) {
    const Setting s = random_setting(random, i, std::pow(10.0, random.between(-7, 0)));
    SCOPED_TRACE("setting " + std::to_string(i) + ": " + text(s));
    const PartialBounds bounds = s.bounds();
    for (int k = 0; k < 4; ++k) {
      const double f = within(random, s.f, k), G = within(random, s.G, k);
      const Correction c = s.at(within(random, s.alpha, k));
      if (c.is_trivial(f)) continue;
      behind += c.in_cavity_branch(f, G);
      expect_holds(bounds, c.partials(f, G));
    }
  }
  EXPECT_GT(behind, 20'000);
}

TEST(BoundedPartials, HoldDifferencesOfValues) {
  Random random(20261123);
  for (int i = 0; i < 30'000 && !HasFailure(); ++i) {
    const Setting s = random_setting(random, i, std::pow(10.0, random.between(-3, 0)));
    SCOPED_TRACE("setting " + std::to_string(i) + ": " + text(s));
    const PartialBounds bounds = s.bounds();
    const double f = within(random, s.f, 2), other_f = within(random, s.f, 2), G = within(random, s.G, 2),
                 other_G = within(random, s.G, 2), a = within(random, s.alpha, 2), b = within(random, s.alpha, 2);
    if (s.at(a).is_trivial(f) || s.at(b).is_trivial(f)) continue;
    expect_holds_difference(bounds, {f, G, a, s.at(a).value(f, G)},
                            {other_f, other_G, b, s.at(b).value(other_f, other_G)});
  }
}

// Away from the edges of the pieces bounds shrink with the intervals: else rays would stay undecided.
TEST(BoundedPartials, ComeNearThePartials) {
  Random random(20261124);
  constexpr double width = 1e-5;
  int narrow = 0, all = 0;
  for (int i = 0; i < 20'000; ++i) {
    Setting s = random_setting(random, 3 * i, width);
    const double alpha = random.between(0.2, 1.4);
    s.alpha = alpha;
    if (s.f.lo < 0.1 || s.G.lo < 0.1) continue;
    const PartialBounds bounds = s.bounds();
    const CorrectionPartials p = s.at(alpha).partials(s.f.lo, s.G.lo);
    all += 1;
    narrow += bounds.df.width() < 0.01 * (std::fabs(p.df) + 1) && bounds.dG.width() < 0.01 * (std::fabs(p.dG) + 1);
  }
  std::cout << "  " << narrow << " of " << all << " narrow\n";
  EXPECT_GT(narrow, all * 97 / 100);
}

TEST(CurveBounds, HoldSlopesAndChords) {
  Random random(20261125);
  for (int i = 0; i < 20'000 && !HasFailure(); ++i) {
    const Kernel kernel = random_kernel(random, i);
    SCOPED_TRACE("setting " + std::to_string(i));
    const BoundedCurve curve(kernel);
    const CurveBounds bounds(curve);
    const double width = std::pow(10.0, random.between(-6, 0.3)), top = curve.top_field();
    const Interval a = around(random, top * random.between(0, 1.2), width);
    const Interval b =
        around(random, top * (i % 3 == 0 ? random.between(0, 2) : std::fabs(1 + width * random.between(-2, 2))), width);
    const double x = within(random, a, i % 7), y = within(random, b, i % 5);
    const CurveBounds::Span from = bounds.span(a), to = bounds.span(b);
    EXPECT_TRUE(bounds.slope(from).contains(curve.slope(x)));
    if (std::fabs(x - y) < 1e-3 * top) continue;  // differences lose more than the bounds allow
    const double chord = (curve.at(x) - curve.at(y)) / (x - y);
    EXPECT_TRUE(bounds.chord(from, to).contains(chord))
        << chord << " is not in " << bounds.chord(from, to).lo << " .. " << bounds.chord(from, to).hi;
    const double G = std::min(curve.top() * random.between(0, 1), curve.top());
    const Interval root = bounds.inverse(G);
    EXPECT_LE(curve.at(root.lo), G * (1 + 1e-12));
    EXPECT_GE(curve.at(root.hi), G * (1 - 1e-12));
  }
}

}  // namespace
}  // namespace marrow
