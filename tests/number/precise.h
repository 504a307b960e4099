// A number of higher precision for formulas: what doubles and intervals are held against.
#pragma once

#include <cmath>

#include "field/number/functions.h"

// A namespace of its own, so that these functions do not hide those of doubles in tests.
namespace marrow::test::precision {

/// 64 bits of mantissa instead of 53, and no overflow where doubles have one.
struct Precise {
  long double v = 0;

  constexpr Precise() = default;
  constexpr Precise(double x) : v(x) {}
  static constexpr Precise of(long double x) {
    Precise p;
    p.v = x;
    return p;
  }

  friend constexpr Precise operator+(Precise a, Precise b) { return of(a.v + b.v); }
  friend constexpr Precise operator-(Precise a, Precise b) { return of(a.v - b.v); }
  friend constexpr Precise operator-(Precise a) { return of(-a.v); }
  friend constexpr Precise operator*(Precise a, Precise b) { return of(a.v * b.v); }
  friend constexpr Precise operator/(Precise a, Precise b) { return of(a.v / b.v); }
  friend constexpr bool operator==(Precise a, Precise b) { return a.v == b.v; }
  friend constexpr auto operator<=>(Precise a, Precise b) { return a.v <=> b.v; }
  constexpr Precise& operator+=(Precise b) { return *this = *this + b; }
  constexpr Precise& operator-=(Precise b) { return *this = *this - b; }
  constexpr Precise& operator*=(Precise b) { return *this = *this * b; }
};

constexpr double lower(Precise x) { return static_cast<double>(x.v); }
constexpr double upper(Precise x) { return static_cast<double>(x.v); }
constexpr Precise value_of(Precise x) { return x; }
constexpr Precise min(Precise a, Precise b) { return b < a ? b : a; }
constexpr Precise max(Precise a, Precise b) { return a < b ? b : a; }
inline Precise abs(Precise x) { return Precise::of(std::fabs(x.v)); }
constexpr Precise square(Precise x) { return x * x; }
inline Precise sqrt(Precise x) { return Precise::of(std::sqrt(x.v)); }
inline Precise exp(Precise x) { return Precise::of(std::exp(x.v)); }
inline Precise log(Precise x) { return Precise::of(std::log(x.v)); }
inline Precise asin(Precise x) { return Precise::of(std::asin(x.v)); }
inline Precise atan(Precise x) { return Precise::of(std::atan(x.v)); }
inline Precise sin(Precise x) { return Precise::of(std::sin(x.v)); }
inline Precise cos(Precise x) { return Precise::of(std::cos(x.v)); }
inline Precise pow(Precise x, double e) { return Precise::of(std::pow(x.v, static_cast<long double>(e))); }
inline Precise integer_power(Precise x, int n) { return Precise::of(std::pow(x.v, static_cast<long double>(n))); }
struct PreciseSinCos {
  Precise sin, cos;
};
inline PreciseSinCos sincos(Precise x) { return {sin(x), cos(x)}; }

}  // namespace marrow::test::precision

namespace marrow::test {
using precision::Precise;
}

template <>
inline constexpr bool marrow::is_plain_number<marrow::test::precision::Precise> = true;
