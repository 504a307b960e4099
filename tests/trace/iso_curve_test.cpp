// The table of the curve C = 1 never says outside or inside wrongly, and says it nearly always.
#include "field/trace/curve/iso_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (int n = 3; n <= 6; ++n)
    for (const bool cavity : {true, false})
      for (const Projection projection : {Projection::Paper, Projection::Exact})
        for (const double alpha : {-0.6, -0.2, 0.0, 0.003, 0.4, 1.1, contact_alpha(n, cavity, projection), 1.5, 1.57,
                                   1.57079632679, std::numbers::pi / 2})
          if (alpha >= 0 || projection == Projection::Paper) all.push_back({n, alpha, cavity, projection});
  return all;
}

IsoTable usual_table(const Correction& c, double alpha) { return {c, alpha, UpToGradient{usual_gradient(c)}}; }

struct Case {
  Setting setting;
  Correction correction;
  IsoCurve iso;
};

// A table takes some 5 ms.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> made;
    for (const Setting& s : settings()) {
      const Correction c(s.degree, s.alpha, s.cavity, s.projection);
      if (critical_field_of(c) < 100) made.push_back({s, c, IsoCurve(c, s.alpha)});
    }
    return made;
  }();
  return all;
}

// Without cavity correction and with an angle near or below 0, no f is inside whatever G is: there is no curve then,
// and such blends are not rendered.
bool has_no_critical_field(const Setting& s) { return !s.cavity && s.alpha < 0.01; }

TEST(IsoCurve, ExistsWhereSomeFieldIsAlwaysInside) {
  for (const Setting& s : settings())
    EXPECT_EQ(critical_field_of(Correction(s.degree, s.alpha, s.cavity, s.projection)) < 100, !has_no_critical_field(s))
        << name_of(s);
}

// f mostly about the surface, sometimes tiny as it is far away or between skeletons.
double random_field(Random& random) {
  return random.between(0, 1) < 0.2 ? exp(random.between(-20, 0)) : random.between(0, 3.5);
}

TEST(IsoCurve, IsNeverWronglyOutsideOrInside) {
  Random random(31);
  for (const auto& [s, c, iso] : cases()) {
    int outside = 0, inside = 0;
    for (int i = 0; i < 3000; ++i) {
      const double x_low = random_field(random), x_high = x_low + random.between(0, 1) * random.between(0, 0.5);
      const double y = random.between(0, 3.0 * (s.degree - 1));
      if (iso.outside(x_low, x_high, y)) {
        ++outside;
        for (int k = 0; k < 5; ++k) {
          const double x = k == 0 ? x_low : k == 1 ? x_high : random.between(x_low, x_high);
          ASSERT_LT(c.value(x, k < 2 ? y : random.between(0, y)), 1) << name_of(s) << " x=" << x << " y=" << y;
        }
      }
      if (iso.inside(x_low, y)) {
        ++inside;
        for (int k = 0; k < 3; ++k)
          ASSERT_GT(c.value(x_low + (k > 0 ? random.between(0, 3) : 0), y + (k > 1 ? random.between(0, 3) : 0)), 1)
              << name_of(s) << " x=" << x_low << " y=" << y;
      }
    }
    EXPECT_GT(outside, 100) << name_of(s);
    EXPECT_TRUE(s.alpha < 0 || inside > 100) << name_of(s) << ": " << inside;
  }
}

TEST(IsoCurve, IsTight) {
  Random random(32);
  double worst = 0;
  for (const auto& [s, c, iso] : cases()) {
    for (int i = 0; i < 2000; ++i) {
      const double x = random_field(random), y = random.between(0, 2.5 * (s.degree - 1));
      const double value = c.value(x, y);
      if (value < 1 && !iso.outside(x, x, y)) worst = std::max(worst, 1 - value);
      EXPECT_TRUE(value > 0.98 || iso.outside(x, x, y)) << name_of(s) << " x=" << x << " y=" << y << " C=" << value;
    }
  }
  std::cout << "  largest 1 - C not called outside: " << worst << '\n';
}

// Far away the field is next to nothing, and space there must be dropped, whatever alpha.
TEST(IsoCurve, TinyFieldsAreOutside) {
  for (const auto& [s, c, iso] : cases()) {
    for (double f = 0.1; f > 1e-12; f /= 3) EXPECT_TRUE(iso.outside(0, f, f)) << name_of(s) << " up to " << f;
  }
}

TEST(IsoCurve, CriticalFieldIsInsideWhateverTheGradient) {
  for (const auto& [s, c, iso] : cases()) { EXPECT_NEAR(c.value(iso.critical_field(), 0), 1, 1e-6) << name_of(s); }
}

// What the kernels read: on the line of a given u, the point at v = lower has C <= 1.
TEST(IsoCurve, LowerTableIsBelowTheCurve) {
  Random random(33);
  double widest = 0;
  for (const auto& [s, c, iso] : cases()) {
    const IsoCurve::View view = iso.view();
    for (int i = 0; i < 3000; ++i) {
      const double at = random.between(0, view.size - 1.001);
      const auto k = static_cast<int>(at);
      const auto fraction = static_cast<float>(at - k);
      const float v = view.lower[k] + (view.lower[k + 1] - view.lower[k]) * fraction;
      const float middle = view.value[k] + (view.value[k + 1] - view.value[k]) * fraction;
      EXPECT_LE(v, middle);
      widest = std::max(widest, static_cast<double>(middle - v));
      const double u = view.u_begin + at / static_cast<double>(view.inverse_step);
      const double x = v * static_cast<double>(view.sin_theta) - u * static_cast<double>(view.cos_theta);
      const double y = u * static_cast<double>(view.sin_theta) + v * static_cast<double>(view.cos_theta);
      if (x < 0 || y < 0) continue;
      ASSERT_LE(c.value(x, y), 1 + 1e-7) << name_of(s) << " u=" << u << " x=" << x << " y=" << y;
    }
  }
  std::cout << "  widest gap of the table below the curve: " << widest << '\n';
}

// Hits lie where the table says. Straight lines are off where the curve begins steeply (G = 0) and where it ends (f =
// 0), and would be across the border of the cavity branch, where it has a kink.
TEST(IsoCurve, TableIsOnTheCurveAtItsKinkToo) {
  constexpr int steep_entries = 16, last_entries = 16, places = 8;
  int borders = 0;
  double largest = 0;
  for (const auto& [s, c, iso] : cases()) {
    if (!s.cavity || s.projection != Projection::Paper || s.alpha < 0 || s.alpha > 1.56) continue;
    const IsoTable table = usual_table(c, s.alpha);
    const auto in_branch = [&](int i) { return c.in_cavity_branch(table.point(i).x, table.point(i).y); };
    bool before = in_branch(0);
    for (int i = steep_entries; i + last_entries < table.size(); ++i) {
      const bool after = in_branch(i + 1), at_border = before != after || after != in_branch(i - 1);
      borders += before != after;
      before = after;
      if (!at_border && i % 64 > 0) continue;
      const IsoTable::Point a = table.point(i), b = table.point(i + 1);
      if (b.y > 2.5 * (s.degree - 1)) break;
      for (int k = 0; k <= places; ++k) {
        const double u = static_cast<double>(k) / places;
        const double error = c.value(a.x + (b.x - a.x) * u, a.y + (b.y - a.y) * u) - 1;
        largest = std::max(largest, std::fabs(error));
        ASSERT_NEAR(error, 0, 5e-6) << name_of(s) << " entry " << i << ", at the border " << at_border;
      }
    }
  }
  std::cout << "  tables with a border: " << borders << "; C is off by up to " << largest << '\n';
  EXPECT_GT(borders, 10);
}

// Hits are off by what sums in float are, not by what the table is: small angles without cavity correction have a long
// curve, and those near or below 0 one that begins along the axis of G. But for some steps where G is nearly 0 and the
// slope of C is not bounded.
TEST(IsoCurve, LinesAreAsExactAsSums) {
  constexpr double allowed = 7e-7, least_field = 0.35, largest_field = 10, steepest = 3;
  constexpr int most_rough = 16;
  for (const Setting& s : {Setting{3, 0.2664, false}, Setting{3, 0.5, false}, Setting{4, 0}, Setting{6, -0.4},
                           Setting{3, -0.1}, Setting{4, 0.003}, Setting{4, 1.5}, Setting{20, 0.5}}) {
    const Correction c(s.degree, s.alpha, s.cavity, s.projection);
    const IsoTable table = usual_table(c, s.alpha);
    int rough = 0;
    for (int i = 0; i + 1 < table.size(); ++i) {
      const IsoTable::Point a = table.point(i), b = table.point(i + 1), p{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
      if (p.x > least_field && p.x < largest_field && p.y < steepest * (s.degree - 1))
        rough += std::fabs(c.value(p.x, p.y) - 1) > allowed;
    }
    EXPECT_LE(rough, most_rough) << name_of(s);
  }
}

// Beyond its end a table is asked by the line through its last two entries: all fields there are inside. The axis x =
// 0, where it ends, is steep for high degrees, and a line that is steeper let rays leave bodies deep inside.
TEST(IsoCurve, BeyondItsEndAllIsInside) {
  Random random(36);
  for (const int n : {3, 8, 18, 20})
    for (int i = 0; i < 24; ++i) {
      const double alpha = random.between(-0.9, 1.55);
      const IsoTable table = usual_table(Correction(n, alpha, true, Projection::Paper), alpha);
      const IsoCurve::View view = table.view();
      if (table.point(table.size() - 2).x > 0.1) continue;  // ends elsewhere
      const float rise = (view.value[view.size - 1] - view.value[view.size - 2]) * view.inverse_step;
      EXPECT_LE(rise, view.cos_theta / view.sin_theta + 1e-4F) << "n=" << n << " alpha=" << alpha;
    }
}

// The gradient of a disc is large against its field: a segment of a hundredth of its radius has some 7 (n - 1) at the
// surface, where tables near the plain sum have ended if nobody asked for more.
TEST(IsoCurve, KnowsLargeGradientsNearTheSum) {
  Random random(37);
  for (const int n : {3, 4, 8})
    for (const Projection projection : {Projection::Paper, Projection::Exact})
      for (const double alpha : {1.5, 1.56, 1.5707, std::numbers::pi / 2 - 1e-9, std::numbers::pi / 2}) {
        const Correction c(n, alpha, true, projection);
        const IsoCurve iso(c, alpha);
        for (int i = 0; i < 2000; ++i) {
          const double x = random.between(0, 1.2), y = exp(random.between(0, 7)) * (n - 1), value = c.value(x, y);
          if (iso.outside(0, x, y)) { ASSERT_LT(value, 1) << "n=" << n << " alpha=" << alpha << " y=" << y; }
          const IsoCurve::View view = iso.view();
          // As kernels read it.
          const float u = static_cast<float>(y) * view.sin_theta - static_cast<float>(x) * view.cos_theta;
          const float at = std::max(0.0F, (u - view.u_begin) * view.inverse_step);
          const int k = static_cast<int>(std::min(at, static_cast<float>(view.size) - 1.5F));
          const float v = static_cast<float>(x) * view.sin_theta + static_cast<float>(y) * view.cos_theta;
          const float line = view.value[k] + (view.value[k + 1] - view.value[k]) * (at - static_cast<float>(k));
          if (alpha > 1.57079 && std::fabs(value - 1) > 1e-3) { ASSERT_EQ(v < line, value < 1) << "y=" << y; }
          if (alpha > 1.57079 && value < 0.99) { ASSERT_TRUE(iso.outside(0, x, y)) << "n=" << n << " y=" << y; }
        }
      }
}

TEST(IsoCurve, GoesOnUpToTheGradientAskedFor) {
  for (const int n : {3, 4, 8})
    for (const double alpha : {1.5, 1.54, 1.56, 1.57}) {
      const Correction c(n, alpha, true, Projection::Paper);
      const double largest = 10 * usual_gradient(c);
      const IsoTable table(c, alpha, UpToGradient{largest});
      double highest = 0;
      for (int i = 0; i + 1 < table.size(); ++i) {
        const auto [x, y] = table.point(i);
        highest = std::max(highest, y);
        // Toward the axis f = 0 the curve is as steep as a root.
        if (x > 0.3) { EXPECT_NEAR(c.value(x, y), 1, 1e-5) << "n=" << n << " alpha=" << alpha << " y=" << y; }
      }
      EXPECT_TRUE(highest >= 0.99 * largest || table.point(table.size() - 2).x < 0.1)
          << "n=" << n << " alpha=" << alpha;
    }
}

TEST(IsoCurve, HoldsForAllAnglesOfARange) {
  Random random(34);
  for (const auto& [n, lowest] : {std::pair{3, 0.0}, {4, 0.0}, {5, 0.0}, {3, -0.8}, {6, -0.8}}) {
    const double least = random.between(lowest, 0.8 + lowest), most = random.between(1, std::numbers::pi / 2);
    const IsoCurve iso(Correction(n, least, true, Projection::Paper), least, most);
    int outside = 0, inside = 0;
    for (int i = 0; i < 4000; ++i) {
      const double alpha = random.between(least, most);
      const Correction c(n, alpha, true, Projection::Paper);
      const double x = random_field(random), y = random.between(0, 3.0 * (n - 1)), value = c.value(x, y);
      if (iso.outside(0, x, y)) {
        ++outside;
        EXPECT_LT(value, 1) << "n=" << n << " alpha=" << alpha << " x=" << x << " y=" << y;
      }
      if (iso.inside(x, y)) {
        ++inside;
        EXPECT_GT(value, 1) << "n=" << n << " alpha=" << alpha << " x=" << x << " y=" << y;
      }
    }
    EXPECT_GT(outside, 500) << "n=" << n;
    EXPECT_TRUE(least < 0 || inside > 500) << "n=" << n << ": " << inside;
  }
}

// Over a range of angles C is largest at one end, by the side of the reference curve: what kernels and starts of rays
// ask alone.
TEST(IsoCurve, AnglesPullOneWayOnEachSideOfTheReferenceCurve) {
  Random random(35);
  for (const Projection projection : {Projection::Paper, Projection::Exact})
    for (const bool cavity : {true, false})
      for (int n = 3; n <= 8; ++n)
        for (int i = 0; i < 2000; ++i) {
          const double least = projection == Projection::Exact || i % 2 == 0 ? 0 : -1;
          const double a = random.between(least, std::numbers::pi / 2), b = random.between(a, std::numbers::pi / 2);
          const double x = random_field(random), y = random.between(0, 3.0 * (n - 1));
          const double rise =
              Correction(n, b, cavity, projection).value(x, y) - Correction(n, a, cavity, projection).value(x, y);
          const bool right = integer_power(x, n) > integer_power(y / (n - 1), n - 1);
          ASSERT_GE(right ? rise : -rise, -1e-12) << "n=" << n << " x=" << x << " y=" << y << " " << a << " to " << b;
        }
}

}  // namespace
}  // namespace marrow::test
