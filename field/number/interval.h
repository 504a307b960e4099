// Intervals of reals with outward rounding: every operation contains all results of its arguments.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/elementary.h"

namespace marrow {

/// All reals from lo to hi; ends may be infinite. Never empty, never NaN: what is not defined is everything.
struct Interval {
  double lo = 0, hi = 0;

  constexpr Interval() = default;
  constexpr Interval(double x) : lo(x), hi(x) {}
  constexpr Interval(double l, double h) : lo(l), hi(h) {}
  static constexpr Interval everything() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }

  constexpr bool contains(double x) const { return lo <= x && x <= hi; }
  constexpr bool contains(const Interval& b) const { return lo <= b.lo && b.hi <= hi; }
  constexpr double middle() const { return lo + 0.5 * (hi - lo); }
  constexpr double width() const { return hi - lo; }
  friend constexpr bool operator==(const Interval&, const Interval&) = default;
};

namespace rounding {

// An operation rounded to nearest is off by half an ulp at most; |x| 2^-52 is one ulp at least. Twice that for
// elementary functions, which are right to one ulp. Where it vanishes `tiny` stands in: half of the smallest subnormal
// number would do, but what comes of such numbers is a hundred times as slow to multiply.
constexpr double ulp = 0x1p-52;
constexpr double tiny = 0x1p-1000;
constexpr double most = std::numeric_limits<double>::max();
constexpr double inf = std::numeric_limits<double>::infinity();

// What overflowed is above the largest double; functions may overflow early: powers by their ulps, SLEEF's exp and pow
// by a relative 2e-9.
inline double overflowed(double ulps) { return ulps > 1 ? 0.5 * most : most; }

inline double down(double x, double ulps = 1) {
  if (x == inf) return overflowed(ulps);
  return x - (std::fabs(x) * (ulps * ulp) + tiny);
}
inline double up(double x, double ulps = 1) {
  if (x == -inf) return -overflowed(ulps);
  return x + (std::fabs(x) * (ulps * ulp) + tiny);
}
inline Interval outward(double lo, double hi, double ulps = 1) {
  const Interval x{down(lo, ulps), up(hi, ulps)};
  return x.lo <= x.hi ? x : Interval::everything();  // NaN compares false
}
// 0 * inf is 0 where an infinite end is a limit that is never taken.
inline double product(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }
// And inf / inf, the other ends of which have the limits.
inline double quotient(double a, double b) { return std::fabs(b) == inf ? 0 : a / b; }

}  // namespace rounding

inline Interval operator-(const Interval& a) { return {-a.hi, -a.lo}; }
inline Interval operator+(const Interval& a, const Interval& b) { return rounding::outward(a.lo + b.lo, a.hi + b.hi); }
inline Interval operator-(const Interval& a, const Interval& b) { return rounding::outward(a.lo - b.hi, a.hi - b.lo); }
inline Interval operator*(const Interval& a, const Interval& b) {
  using rounding::product;
  if (a == Interval(0) || b == Interval(0)) return 0;
  const double p = product(a.lo, b.lo), q = product(a.lo, b.hi), r = product(a.hi, b.lo), s = product(a.hi, b.hi);
  return rounding::outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
inline Interval operator*(const Interval& a, double s) {
  if (s == 0 || a == Interval(0)) return 0;
  const double p = rounding::product(a.lo, s), q = rounding::product(a.hi, s);
  return s < 0 ? rounding::outward(q, p) : rounding::outward(p, q);
}
inline Interval operator*(double s, const Interval& a) { return a * s; }
inline Interval operator/(const Interval& a, const Interval& b) {
  if (b.contains(0)) return Interval::everything();
  using rounding::quotient;
  const double p = quotient(a.lo, b.lo), q = quotient(a.lo, b.hi), r = quotient(a.hi, b.lo), s = quotient(a.hi, b.hi);
  return rounding::outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
inline Interval& operator+=(Interval& a, const Interval& b) { return a = a + b; }
inline Interval& operator-=(Interval& a, const Interval& b) { return a = a - b; }
inline Interval& operator*=(Interval& a, const Interval& b) { return a = a * b; }

inline Interval hull(const Interval& a, const Interval& b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }
/// What both contain; the nearest end of `b` when they do not meet.
inline Interval clamped(const Interval& a, const Interval& b) {
  return {std::clamp(a.lo, b.lo, b.hi), std::clamp(a.hi, b.lo, b.hi)};
}

inline Interval min(const Interval& a, const Interval& b) { return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)}; }
inline Interval max(const Interval& a, const Interval& b) { return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)}; }
inline Interval abs(const Interval& a) {
  if (a.lo >= 0) return a;
  if (a.hi <= 0) return -a;
  return {0, std::max(-a.lo, a.hi)};
}
inline Interval square(const Interval& a) {
  const Interval m = abs(a);
  return {std::max(0.0, rounding::down(m.lo * m.lo)), rounding::up(m.hi * m.hi)};
}

/// An increasing function that is right to `ulps` ulp at both ends.
template <class Function>
Interval increasing(const Interval& a, Function f, double ulps = 2) {
  return rounding::outward(f(a.lo), f(a.hi), ulps);
}
/// The root of the part that is not negative.
inline Interval sqrt(const Interval& a) {
  return {std::max(0.0, rounding::down(std::sqrt(std::max(0.0, a.lo)))), rounding::up(std::sqrt(std::max(0.0, a.hi)))};
}
inline Interval exp(const Interval& a) {
  const Interval e = increasing(a, [](double x) { return exp(x); });
  return {std::max(0.0, e.lo), e.hi};
}
/// Of the part above 0; below, -infinity.
inline Interval log(const Interval& a) {
  if (a.hi <= 0) return Interval::everything();
  return {a.lo > 0 ? rounding::down(log(a.lo), 2) : -rounding::inf, rounding::up(log(a.hi), 2)};
}
/// Of the part within [-1, 1]; beyond it, of the nearest end.
inline Interval asin(const Interval& a) {
  return increasing(clamped(a, {-1, 1}), [](double x) { return asin(x); });
}
inline Interval atan(const Interval& a) {
  return increasing(a, [](double x) { return atan(x); });
}

namespace rounding {
// Each of the at most 2 log2(n) multiplications adds half an ulp to the ulps it is given, times its weight in the
// power: below n + 6 ulp in all.
inline double power_ulps(int n) { return n + 6; }
}  // namespace rounding

/// a^n for a whole n >= 0.
inline Interval integer_power(const Interval& a, int n) {
  if (n == 0) return 1;
  const double ulps = rounding::power_ulps(n);
  const Interval base = n % 2 == 0 ? abs(a) : a;
  const Interval p = increasing(
      base, [n](double x) { return integer_power(x, n); }, ulps);
  return n % 2 == 0 ? Interval{std::max(0.0, p.lo), p.hi} : p;
}
/// a^e for the part of a that is not negative.
inline Interval pow(const Interval& a, double e) {
  const Interval base{std::max(0.0, a.lo), std::max(0.0, a.hi)};
  const auto power = [e](double x) {
    if (x == 0) return e > 0 ? 0.0 : e == 0 ? 1.0 : rounding::inf;
    if (x == rounding::inf) return e > 0 ? rounding::inf : e == 0 ? 1.0 : 0.0;
    return pow(x, e);
  };
  const Interval p = e >= 0 ? Interval{power(base.lo), power(base.hi)} : Interval{power(base.hi), power(base.lo)};
  const Interval wide = rounding::outward(p.lo, p.hi, 2);
  return {std::max(0.0, wide.lo), p.hi == rounding::inf ? rounding::inf : wide.hi};
}

/// Contains sin x and cos x for every x of the interval.
struct IntervalSinCos {
  Interval sin, cos;
};
IntervalSinCos sincos(const Interval&);
inline Interval sin(const Interval& a) { return sincos(a).sin; }
inline Interval cos(const Interval& a) { return sincos(a).cos; }

}  // namespace marrow
