// Sums of eighth powers of directions; internal to blend/.
#pragma once

#include <array>
#include <cstddef>

#include "field/number/functions.h"

namespace marrow {

/// Sums of w u^8, as the 45 components w u_x^i u_y^j u_z^k, i + j + k = 8.
template <Number X>
class DirectionTensor {
 public:
  static constexpr int power = 8;
  static constexpr std::size_t size = 45;

  void add(const X& weight, const Vec3<X>& u) {
    const Powers x = powers_of(u.x), y = powers_of(u.y), z = powers_of(u.z);
    for (std::size_t b = 0; b < size; ++b)
      components_[b] += weight * (x[exponents[b].i] * y[exponents[b].j] * z[exponents[b].k]);
  }
  /// sum w (u . v)^8
  X along(const Vec3<X>& v) const {
    const Powers x = powers_of(v.x), y = powers_of(v.y), z = powers_of(v.z);
    X sum(0.0);
    for (std::size_t b = 0; b < size; ++b)
      sum += exponents[b].count * components_[b] * (x[exponents[b].i] * y[exponents[b].j] * z[exponents[b].k]);
    return sum;
  }
  /// its gradient by v
  Vec3<X> slope_along(const Vec3<X>& v) const {
    const Powers x = powers_of(v.x), y = powers_of(v.y), z = powers_of(v.z);
    Vec3<X> sum;
    for (std::size_t b = 0; b < size; ++b) {
      const auto [i, j, k, count] = exponents[b];
      const X weight = count * components_[b];
      if (i > 0) sum.x += weight * static_cast<double>(i) * (x[i - 1] * y[j] * z[k]);
      if (j > 0) sum.y += weight * static_cast<double>(j) * (x[i] * y[j - 1] * z[k]);
      if (k > 0) sum.z += weight * static_cast<double>(k) * (x[i] * y[j] * z[k - 1]);
    }
    return sum;
  }

 private:
  struct Exponents {
    std::size_t i, j, k;
    double count;  // 8! / (i! j! k!)
  };
  static constexpr std::array<Exponents, size> exponents = [] {
    std::array<double, power + 1> factorial{1};
    for (std::size_t i = 1; i <= power; ++i) factorial[i] = factorial[i - 1] * static_cast<double>(i);
    std::array<Exponents, size> all{};
    std::size_t at = 0;
    for (std::size_t i = 0; i <= power; ++i)
      for (std::size_t j = 0; i + j <= power; ++j) {
        const std::size_t k = power - i - j;
        all[at++] = {i, j, k, factorial[power] / (factorial[i] * factorial[j] * factorial[k])};
      }
    return all;
  }();

  using Powers = std::array<X, power + 1>;
  static Powers powers_of(const X& x) {
    Powers all;
    all[0] = X(1.0);
    for (std::size_t i = 1; i <= power; ++i) all[i] = all[i - 1] * x;
    return all;
  }

  std::array<X, size> components_{};
};

}  // namespace marrow
