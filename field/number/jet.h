// Numbers that carry derivatives: a value with its gradient, and one with its Hessian too.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>

#include "field/number/interval.h"

namespace marrow {

/// Value and the partial derivatives by N variables. T is double or Interval; with intervals the slopes enclose every
/// generalised (Clarke) derivative over the box of the variables, so that they bound differences across kinks too.
template <class T, std::size_t N>
struct Jet {
  using Scalar = T;
  T value{};
  std::array<T, N> slope{};

  constexpr Jet() = default;
  constexpr Jet(T v) : value(v) {}
  constexpr Jet(double v) requires(!std::same_as<T, double>) : value(v) {}
  static constexpr Jet variable(T v, std::size_t i) {
    Jet x(v);
    x.slope[i] = T(1);
    return x;
  }
  /// f(x) from f, f' and f'' at x.value.
  static Jet chain(const Jet& x, const T& f, const T& df, const T&) {
    Jet r(f);
    for (std::size_t i = 0; i < N; ++i) r.slope[i] = df * x.slope[i];
    return r;
  }

  friend Jet operator+(const Jet& a, const Jet& b) {
    Jet r(a.value + b.value);
    for (std::size_t i = 0; i < N; ++i) r.slope[i] = a.slope[i] + b.slope[i];
    return r;
  }
  friend Jet operator-(const Jet& a) {
    Jet r(-a.value);
    for (std::size_t i = 0; i < N; ++i) r.slope[i] = -a.slope[i];
    return r;
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    Jet r(a.value - b.value);
    for (std::size_t i = 0; i < N; ++i) r.slope[i] = a.slope[i] - b.slope[i];
    return r;
  }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet r(a.value * b.value);
    for (std::size_t i = 0; i < N; ++i) r.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
    return r;
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    Jet r(a.value / b.value);
    for (std::size_t i = 0; i < N; ++i) r.slope[i] = (a.slope[i] - r.value * b.slope[i]) / b.value;
    return r;
  }
  // Constants move no slope.
  friend Jet operator+(Jet a, double b) {
    a.value = a.value + T(b);
    return a;
  }
  friend Jet operator+(double a, const Jet& b) { return b + a; }
  friend Jet operator-(const Jet& a, double b) { return a + -b; }
  friend Jet operator-(double a, const Jet& b) { return -b + a; }
  friend Jet operator*(Jet a, double s) {
    a.value = a.value * s;
    for (T& slope : a.slope) slope = slope * s;
    return a;
  }
  friend Jet operator*(double s, const Jet& a) { return a * s; }
  Jet& operator+=(const Jet& b) { return *this = *this + b; }
  Jet& operator-=(const Jet& b) { return *this = *this - b; }
  Jet& operator*=(const Jet& b) { return *this = *this * b; }
};

/// Value, gradient and the six different second derivatives by a position.
struct HessianJet {
  using Scalar = double;
  /// Row and column of each of the six.
  static constexpr std::array<std::array<std::size_t, 2>, 6> at{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};

  double value = 0;
  std::array<double, 3> slope{};
  std::array<double, 6> curvature{};

  constexpr HessianJet() = default;
  constexpr HessianJet(double v) : value(v) {}
  static constexpr HessianJet variable(double v, std::size_t i) {
    HessianJet x(v);
    x.slope[i] = 1;
    return x;
  }
  static HessianJet chain(const HessianJet& x, double f, double df, double ddf) {
    HessianJet r(f);
    for (std::size_t i = 0; i < 3; ++i) r.slope[i] = df * x.slope[i];
    for (std::size_t k = 0; k < 6; ++k) {
      r.curvature[k] = df * x.curvature[k];
      const double slopes = x.slope[at[k][0]] * x.slope[at[k][1]];
      if (slopes != 0) r.curvature[k] += ddf * slopes;  // f'' may be infinite where x does not move
    }
    return r;
  }

  friend HessianJet operator+(const HessianJet& a, const HessianJet& b) {
    HessianJet r(a.value + b.value);
    for (std::size_t i = 0; i < 3; ++i) r.slope[i] = a.slope[i] + b.slope[i];
    for (std::size_t k = 0; k < 6; ++k) r.curvature[k] = a.curvature[k] + b.curvature[k];
    return r;
  }
  friend HessianJet operator-(const HessianJet& a) { return chain(a, -a.value, -1, 0); }
  friend HessianJet operator-(const HessianJet& a, const HessianJet& b) { return a + -b; }
  friend HessianJet operator*(const HessianJet& a, const HessianJet& b) {
    HessianJet r(a.value * b.value);
    for (std::size_t i = 0; i < 3; ++i) r.slope[i] = a.slope[i] * b.value + a.value * b.slope[i];
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [i, j] = at[k];
      r.curvature[k] =
          a.curvature[k] * b.value + a.value * b.curvature[k] + a.slope[i] * b.slope[j] + a.slope[j] * b.slope[i];
    }
    return r;
  }
  friend HessianJet operator/(const HessianJet& a, const HessianJet& b) {
    const double r = 1 / b.value;
    return a * chain(b, r, -r * r, 2 * r * r * r);
  }
  friend HessianJet operator+(HessianJet a, double b) {
    a.value += b;
    return a;
  }
  friend HessianJet operator+(double a, const HessianJet& b) { return b + a; }
  friend HessianJet operator-(const HessianJet& a, double b) { return a + -b; }
  friend HessianJet operator-(double a, const HessianJet& b) { return -b + a; }
  friend HessianJet operator*(const HessianJet& a, double s) { return chain(a, a.value * s, s, 0); }
  friend HessianJet operator*(double s, const HessianJet& a) { return a * s; }
  HessianJet& operator+=(const HessianJet& b) { return *this = *this + b; }
  HessianJet& operator-=(const HessianJet& b) { return *this = *this - b; }
  HessianJet& operator*=(const HessianJet& b) { return *this = *this * b; }
};

}  // namespace marrow
