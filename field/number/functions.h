// What a formula may be written with, for every type of number: double, Interval, and jets of both.
//
// A formula that is a template over its number gives value, gradient, Hessian and enclosures, which so cannot disagree.
// Branches go through piecewise(), min() and max(): over an interval both sides count.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>

#include "field/math/vec3.h"
#include "field/number/jet.h"

namespace marrow {

template <class X>
concept JetNumber = requires {
  typename X::Scalar;
};
/// Numbers without derivatives. A type with the functions below may join them; tests add one of higher precision.
template <class X>
inline constexpr bool is_plain_number = std::same_as<X, double> || std::same_as<X, Interval>;
template <class X>
concept Number = is_plain_number<X> || JetNumber<X>;

namespace number_detail {

template <class X>
struct ScalarOf {
  using type = X;
};
template <JetNumber X>
struct ScalarOf<X> {
  using type = typename X::Scalar;
};

}  // namespace number_detail

/// double or Interval.
template <Number X>
using ScalarOf = typename number_detail::ScalarOf<X>::type;

template <Number X>
inline constexpr bool is_enclosure = std::same_as<ScalarOf<X>, Interval>;

/// The value without derivatives.
constexpr double value_of(double x) { return x; }
constexpr const Interval& value_of(const Interval& x) { return x; }
template <JetNumber X>
constexpr const typename X::Scalar& value_of(const X& x) {
  return x.value;
}

/// The bounds of a value; a double is both.
constexpr double lower(double x) { return x; }
constexpr double upper(double x) { return x; }
constexpr double lower(const Interval& x) { return x.lo; }
constexpr double upper(const Interval& x) { return x.hi; }
template <JetNumber X>
constexpr double lower(const X& x) {
  return lower(x.value);
}
template <JetNumber X>
constexpr double upper(const X& x) {
  return upper(x.value);
}

template <std::size_t N>
Jet<Interval, N> hull(const Jet<Interval, N>& a, const Jet<Interval, N>& b) {
  Jet<Interval, N> r(hull(a.value, b.value));
  for (std::size_t i = 0; i < N; ++i) r.slope[i] = hull(a.slope[i], b.slope[i]);
  return r;
}

/// An enclosure of a number of which nothing is known but where it lies.
template <Number X>
X any_slope(const Interval& values) {
  if constexpr (JetNumber<X>) {
    X r(values);
    r.slope.fill(Interval::everything());
    return r;
  } else {
    return values;
  }
}

/// Anything from x on, with any slope.
template <Number X>
X at_least(double x) {
  return any_slope<X>({x, std::numeric_limits<double>::infinity()});
}

namespace number_detail {

template <Number X>
X within(X x, double lo, double hi) {
  if constexpr (std::same_as<X, Interval>) return clamped(x, {lo, hi});
  else if constexpr (is_enclosure<X>) x.value = clamped(x.value, {lo, hi});
  return x;
}

}  // namespace number_detail

/// x, which is known to lie in lo .. hi: enclosures lose what rounding or their arguments' independence added.
template <Number X>
X known_within(const X& x, double lo, double hi) {
  return number_detail::within(x, lo, hi);
}

/// left(x) where x < knot and right(x) from there on. Both must agree at the knot, and each side sees only its part.
template <Number X, class Left, class Right>
X piecewise(const X& x, double knot, Left left, Right right) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  if (lower(x) >= knot) return right(x);
  if (upper(x) < knot) return left(x);
  if constexpr (is_enclosure<X>)
    return hull(left(number_detail::within(x, -inf, knot)), right(number_detail::within(x, knot, inf)));
  else return right(x);
}

constexpr double min(double a, double b) { return b < a ? b : a; }
constexpr double max(double a, double b) { return a < b ? b : a; }
/// Where both are equal a double takes the slopes of a; an enclosure takes all.
template <JetNumber X>
X max(const X& a, const X& b) {
  if constexpr (is_enclosure<X>) {
    if (lower(a) > upper(b)) return a;
    if (lower(b) > upper(a)) return b;
    X r = hull(a, b);
    r.value = max(a.value, b.value);
    return r;
  } else {
    return a.value < b.value ? b : a;
  }
}
template <JetNumber X>
X min(const X& a, const X& b) {
  return -max(-a, -b);
}
template <Number X>
X clamp(const X& x, double lo, double hi) {
  return min(max(x, X(lo)), X(hi));
}
inline double abs(double x) { return std::fabs(x); }
template <JetNumber X>
X abs(const X& x) {
  return max(x, -x);
}

constexpr double square(double x) { return x * x; }
template <JetNumber X>
X square(const X& x) {
  using T = typename X::Scalar;
  return X::chain(x, square(x.value), T(2) * x.value, T(2));
}

inline double sqrt(double x) { return std::sqrt(x); }
/// Of what is not negative; at 0 the slope of a double is taken as 0.
template <JetNumber X>
X sqrt(const X& x) {
  using T = typename X::Scalar;
  const T root = sqrt(x.value);
  if constexpr (!is_enclosure<X>)
    if (root == 0) return X(0.0);
  const T slope = T(0.5) / root;
  return X::chain(x, root, slope, T(-0.5) * slope / x.value);
}

template <JetNumber X>
X integer_power(const X& x, int n) {
  using T = typename X::Scalar;
  if (n == 0) return X(1.0);
  const T second = n == 1 ? T(0.0) : T(double(n) * (n - 1)) * integer_power(x.value, n - 2);
  return X::chain(x, integer_power(x.value, n), T(double(n)) * integer_power(x.value, n - 1), second);
}
/// x^e for x >= 0.
template <JetNumber X>
X pow(const X& x, double e) {
  using T = typename X::Scalar;
  const T second = e == 0 || e == 1 ? T(0.0) : T(e * (e - 1)) * pow(x.value, e - 2);
  return X::chain(x, pow(x.value, e), e == 0 ? T(0.0) : T(e) * pow(x.value, e - 1), second);
}
template <JetNumber X>
X exp(const X& x) {
  const auto e = exp(x.value);
  return X::chain(x, e, e, e);
}
template <JetNumber X>
X log(const X& x) {
  using T = typename X::Scalar;
  const T r = T(1.0) / x.value;
  return X::chain(x, log(x.value), r, -r * r);
}
template <JetNumber X>
struct JetSinCos {
  X sin, cos;
};
template <JetNumber X>
JetSinCos<X> sincos(const X& x) {
  const auto w = sincos(x.value);
  return {X::chain(x, w.sin, w.cos, -w.sin), X::chain(x, w.cos, -w.sin, -w.cos)};
}
template <JetNumber X>
X sin(const X& x) {
  return sincos(x).sin;
}
template <JetNumber X>
X cos(const X& x) {
  return sincos(x).cos;
}
/// For |x| < 1, where slopes are finite.
template <JetNumber X>
X asin(const X& x) {
  using T = typename X::Scalar;
  const T rest = (T(1.0) - x.value) * (T(1.0) + x.value), slope = T(1.0) / sqrt(rest);
  return X::chain(x, asin(x.value), slope, x.value * slope / rest);
}
template <JetNumber X>
X atan(const X& x) {
  using T = typename X::Scalar;
  const T d = T(1.0) / (T(1.0) + square(x.value));
  return X::chain(x, atan(x.value), d, T(-2.0) * x.value * d * d);
}

/// Euclidean norm. Its slopes stay bounded at 0, where a double takes 0 for them.
template <Number X>
requires(!std::same_as<X, double>) X length(const Vec3<X>& v) {
  if constexpr (!JetNumber<X>) {
    return sqrt(square(v.x) + square(v.y) + square(v.z));
  } else if constexpr (!is_enclosure<X>) {
    return sqrt(square(v.x) + square(v.y) + square(v.z));
  } else {
    X r(sqrt(square(v.x.value) + square(v.y.value) + square(v.z.value)));
    for (std::size_t k = 0; k < 3; ++k) {
      const Interval share = clamped(v[k].value / r.value, {-1, 1});
      for (std::size_t i = 0; i < r.slope.size(); ++i) r.slope[i] += share * v[k].slope[i];
    }
    return r;
  }
}

/// Of a vector in a plane.
template <Number X>
X length(const X& a, const X& b) {
  return length(Vec3<X>{a, b, X(0.0)});
}

/// With a constant vector, for less than with one of numbers.
template <Number X>
requires(!std::same_as<X, double>) X dot(const Vec3<X>& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <Number X>
requires(!std::same_as<X, double>) Vec3<X>
operator-(const Vec3<X>& a, const Vec3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// A constant vector as one of numbers.
template <Number X>
Vec3<X> constant(const Vec3d& v) {
  return {X(v.x), X(v.y), X(v.z)};
}

}  // namespace marrow
