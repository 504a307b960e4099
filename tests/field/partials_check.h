// What bounds of the partial derivatives of the correction operator are held against.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "field/blend/bounds/correction/correction_bounds.h"
#include "tests/field/random.h"

namespace marrow::test {

/// For k = 0 and 1 an end, else any place of the interval.
inline double within(Random& random, const Interval& x, int k) {
  return k == 0 ? x.lo : k == 1 ? x.hi : std::clamp(random.between(x.lo, x.hi), x.lo, x.hi);
}

inline std::string text(const Interval& x) { return std::to_string(x.lo) + " .. " + std::to_string(x.hi); }

inline void expect_holds(const Interval& bounds, double x, const char* name) {
  const double slack = 1e-8 * std::fabs(x) + 1e-9;
  EXPECT_TRUE(bounds.lo - slack <= x && x <= bounds.hi + slack)
      << name << " " << x << " is not in " << bounds.lo << " .. " << bounds.hi;
}

inline void expect_holds(const PartialBounds& bounds, const CorrectionPartials& p) {
  expect_holds(bounds.df, p.df, "df");
  expect_holds(bounds.dG, p.dG, "dG");
  expect_holds(bounds.dalpha, p.dalpha, "dalpha");
}

/// What the operator is applied to, and what it gives.
struct AppliedTo {
  double f, G, alpha, C;
};

/// The mean value theorem: what slopes of rays are used for. Finds derivatives that are wrong in the operator too.
inline void expect_holds_difference(const PartialBounds& bounds, const AppliedTo& a, const AppliedTo& b) {
  const auto change = [](const Interval& slope, double from, double to) {
    return from == to ? Interval(0) : slope * (Interval(to) - Interval(from));
  };
  const double slack = 1e-11 * (1 + a.C);
  const Interval all =
      change(bounds.df, a.f, b.f) + change(bounds.dG, a.G, b.G) + change(bounds.dalpha, a.alpha, b.alpha);
  EXPECT_TRUE(all.lo - slack <= b.C - a.C && b.C - a.C <= all.hi + slack)
      << b.C - a.C << " is not in " << all.lo << " .. " << all.hi;
}

}  // namespace marrow::test
