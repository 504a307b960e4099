// Every function of intervals holds the exact results of what its arguments hold, and little more.
#include "field/number/interval.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "tests/field/random.h"
#include "tests/number/precise.h"

namespace marrow::test {
namespace {

constexpr double inf = rounding::inf, most = rounding::most, tiny = rounding::tiny, normal = 0x1p-1022;
constexpr std::array special{0.0,   tiny,  -tiny,    normal,   -normal, 1.0,    -1.0,  0.5,    2.0,     -2.0,  most,
                             -most, 1e154, -1.3e154, 1.5e-154, 1e-162,  1e-300, 1e300, -1e300, 709.782, -745.2};

int wanted_rounds() {
  const char* text = std::getenv("MARROW_LAW_CHECKS");
  return text ? std::atoi(text) : 20000;
}

double any_double(Random& random) {
  const double kind = random.between(0, 1);
  if (kind < 0.25) return special[static_cast<std::size_t>(random.whole(0, special.size() - 1))];
  const double sign = random.between(0, 1) < 0.5 ? -1 : 1;
  if (kind < 0.6) return sign * random.between(0, 8);
  return sign * std::ldexp(random.between(1, 2), random.whole(-1074, 1023));
}
/// A point, some ulp, or wide, with infinite ends now and then.
Interval any_interval(Random& random) {
  const double a = any_double(random), kind = random.between(0, 1);
  if (kind < 0.3) return a;
  if (kind < 0.5) return {a, a + std::fabs(a) * random.between(0, 1e-12)};
  const double b = any_double(random);
  Interval x{std::min(a, b), std::max(a, b)};
  if (kind > 0.97) x.hi = inf;
  else if (kind > 0.94) x.lo = -inf;
  return x;
}
double point_of(const Interval& x, int which, Random& random) {
  const double lo = std::max(x.lo, -most), hi = std::min(x.hi, most);
  if (which == 0) return lo;
  if (which == 1) return hi;
  const double t = random.between(0, 1);
  return std::clamp(lo * (1 - t) + hi * t, lo, hi);
}
bool within(const Interval& bounds, long double x) { return bounds.lo <= x && x <= bounds.hi; }

struct Unary {
  const char* name;
  Interval (*bounds)(const Interval&);
  Precise (*exact)(Precise);
  double least;  ///< arguments below this (or equal, when it is 0 and the function has a pole) do not count
  double ulps;   ///< of the width for a single argument of ordinary size
};
const Unary unary[] = {
    {"-", [](const Interval& x) { return -x; }, [](Precise x) { return -x; }, -inf, 0},
    {"abs", [](const Interval& x) { return abs(x); }, [](Precise x) { return abs(x); }, -inf, 0},
    {"square", [](const Interval& x) { return square(x); }, [](Precise x) { return square(x); }, -inf, 4},
    {"sqrt", [](const Interval& x) { return sqrt(x); }, [](Precise x) { return sqrt(x); }, 0, 4},
    {"exp", [](const Interval& x) { return exp(x); }, [](Precise x) { return exp(x); }, -inf, 8},
    {"log", [](const Interval& x) { return log(x); }, [](Precise x) { return log(x); }, tiny, 8},
    {"asin", [](const Interval& x) { return asin(x); }, [](Precise x) { return asin(min(max(x, -1), 1)); }, -inf, 8},
    {"atan", [](const Interval& x) { return atan(x); }, [](Precise x) { return atan(x); }, -inf, 8},
    {"sin", [](const Interval& x) { return sin(x); }, [](Precise x) { return sin(x); }, -inf, 8},
    {"cos", [](const Interval& x) { return cos(x); }, [](Precise x) { return cos(x); }, -inf, 8},
};

TEST(Interval, FunctionsHoldTheirExactValues) {
  for (const Unary& f : unary) {
    SCOPED_TRACE(f.name);
    Random random(11);
    for (int i = 0; i < wanted_rounds() && !HasFailure(); ++i) {
      const Interval x = any_interval(random), y = f.bounds(x);
      for (int k = 0; k < 4; ++k) {
        const double at = point_of(x, k, random);
        if (at < f.least) continue;
        const Precise exact = f.exact(at);
        EXPECT_TRUE(within(y, exact.v)) << "of " << at << " in " << x.lo << " .. " << x.hi << ": " << y.lo << " .. "
                                        << y.hi;
      }
    }
  }
}

// Otherwise everything would be a right answer.
TEST(Interval, FunctionsOfPointsAreNarrow) {
  for (const Unary& f : unary) {
    SCOPED_TRACE(f.name);
    Random random(12);
    for (int i = 0; i < 2000; ++i) {
      const double x = random.between(std::max(f.least, -6.0), 6.0);
      const Interval y = f.bounds(x);
      EXPECT_LE(y.width(), (f.ulps * std::fabs(y.middle()) + (f.ulps > 0 ? 4e-308 : 0)) * 0x1p-52) << x;
    }
  }
}

struct Binary {
  const char* name;
  Interval (*bounds)(const Interval&, const Interval&);
  Precise (*exact)(Precise, Precise);
};
const Binary binary[] = {
    {"+", [](const Interval& x, const Interval& y) { return x + y; }, [](Precise x, Precise y) { return x + y; }},
    {"-", [](const Interval& x, const Interval& y) { return x - y; }, [](Precise x, Precise y) { return x - y; }},
    {"*", [](const Interval& x, const Interval& y) { return x * y; }, [](Precise x, Precise y) { return x * y; }},
    {"/", [](const Interval& x, const Interval& y) { return x / y; }, [](Precise x, Precise y) { return x / y; }},
    {"min", [](const Interval& x, const Interval& y) { return min(x, y); },
     [](Precise x, Precise y) { return min(x, y); }},
    {"max", [](const Interval& x, const Interval& y) { return max(x, y); },
     [](Precise x, Precise y) { return max(x, y); }},
    {"hull", [](const Interval& x, const Interval& y) { return hull(x, y); }, [](Precise x, Precise) { return x; }},
};

TEST(Interval, OperationsHoldTheirExactValues) {
  for (const Binary& f : binary) {
    SCOPED_TRACE(f.name);
    Random random(13);
    for (int i = 0; i < wanted_rounds() && !HasFailure(); ++i) {
      const Interval x = any_interval(random), y = any_interval(random), z = f.bounds(x, y);
      for (int k = 0; k < 6; ++k) {
        const double a = point_of(x, k % 3, random), b = point_of(y, k / 2, random);
        if (f.name[0] == '/' && b == 0) continue;
        EXPECT_TRUE(within(z, f.exact(a, b).v)) << a << ", " << b << " gives " << z.lo << " .. " << z.hi;
        EXPECT_LE(z.lo, z.hi);
      }
    }
  }
}

TEST(Interval, TimesANumberIsTimesAPoint) {
  Random random(18);
  for (int i = 0; i < wanted_rounds(); ++i) {
    const Interval x = any_interval(random);
    const double s = any_double(random);
    ASSERT_EQ(x * s, x * Interval(s)) << x.lo << " .. " << x.hi << " times " << s;
    ASSERT_EQ(s * x, x * s);
  }
}

TEST(Interval, OperationsOnPointsAreNarrow) {
  Random random(14);
  for (int i = 0; i < 2000; ++i) {
    const double x = random.between(-5, 5), y = random.between(-5, 5);
    for (const Binary& f : binary) {
      if (f.name[0] == 'h') continue;
      const Interval z = f.bounds(x, y);
      EXPECT_LE(z.width(), 4 * 0x1p-52 * std::fabs(z.middle()) + 1e-300) << f.name;
    }
  }
}

TEST(Interval, PowersHoldTheirExactValues) {
  Random random(15);
  for (int i = 0; i < wanted_rounds() && !HasFailure(); ++i) {
    const Interval x = any_interval(random);
    const int n = random.whole(0, 12);
    const double e = i % 3 == 0 ? random.whole(-4, 6) : random.between(-4, 6);
    const Interval whole = integer_power(x, n), real = pow(x, e);
    for (int k = 0; k < 4; ++k) {
      const double at = point_of(x, k, random);
      EXPECT_TRUE(within(whole, integer_power(Precise(at), n).v))
          << at << "^" << n << " " << whole.lo << " .. " << whole.hi;
      if (at < 0 || (at == 0 && e < 0)) continue;
      EXPECT_TRUE(within(real, pow(Precise(at), e).v)) << at << "^" << e << " " << real.lo << " .. " << real.hi;
    }
  }
}

// A result may overflow that is below the largest double.
TEST(Interval, BoundsHoldWhereResultsBeginToOverflow) {
  for (int n = 2; n <= 12; ++n) {
    double x = std::pow(most, 1.0 / n) * (1 - 100 * 0x1p-53);
    for (int step = 0; step < 200; ++step, x = std::nextafter(x, inf)) {
      EXPECT_TRUE(within(integer_power(Interval(x), n), integer_power(Precise(x), n).v)) << x << "^" << n;
      EXPECT_TRUE(within(pow(Interval(x), n), integer_power(Precise(x), n).v)) << x << "^" << n;
    }
  }
  double x = 709.78271289338;
  for (int step = 0; step < 200; ++step, x = std::nextafter(x, inf))
    EXPECT_TRUE(within(exp(Interval(x)), exp(Precise(x)).v)) << x;
}

TEST(Interval, PowersOfPointsAreNarrow) {
  Random random(16);
  for (int i = 0; i < 2000; ++i) {
    const double x = random.between(0.1, 5), e = random.between(-3, 3);
    const int n = random.whole(0, 9);
    const Interval whole = integer_power(x, n), real = pow(x, e);
    EXPECT_LE(whole.width(), (2 * n + 14) * 0x1p-52 * whole.middle());
    EXPECT_LE(real.width(), 6 * 0x1p-52 * real.middle());
  }
}

TEST(Interval, WavesOverWholeTurnsReachOne) {
  Random random(17);
  for (int i = 0; i < 5000; ++i) {
    const double at = random.between(-2000, 2000), width = random.between(0, 8);
    const IntervalSinCos w = sincos(Interval{at, at + width});
    double top = -1, bottom = 1;
    for (int k = 0; k <= 400; ++k) {
      const double s = std::sin(at + width * k / 400);
      top = std::max(top, s);
      bottom = std::min(bottom, s);
    }
    EXPECT_GE(w.sin.hi, top);
    EXPECT_LE(w.sin.lo, bottom);
    EXPECT_LE(w.sin.hi, top + 1e-3);  // the sampling of 8 by 400 steps: (8 / 800)^2 / 2
    EXPECT_GE(w.sin.lo, bottom - 1e-3);
  }
}

TEST(Interval, WhatIsNotDefinedIsEverything) {
  const Interval everything = Interval::everything();
  EXPECT_EQ(Interval(1) / Interval(-1, 1), everything);
  EXPECT_EQ(Interval(0, 1) / Interval(0, 1), everything);
  EXPECT_EQ(log(Interval(-2, -1)), everything);
  EXPECT_EQ(Interval(inf) - Interval(inf), everything);
  EXPECT_EQ(Interval(0) * everything, Interval(0));
  EXPECT_EQ(sincos(everything).sin, Interval(-1, 1));
  EXPECT_EQ(sincos(Interval(1e300)).cos, Interval(-1, 1));
}

}  // namespace
}  // namespace marrow::test
