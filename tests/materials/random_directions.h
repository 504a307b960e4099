// Repeatable random numbers and directions for the tests of materials.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "field/math/elementary.h"
#include "field/math/vec3.h"
#include "materials/sample.h"

namespace marrow {

/// The same numbers on every machine: only the engine of <random> is specified to the bit, its distributions are not.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  Sample2 square() {
    const double x = unit();
    return {x, unit()};
  }
  Sample3 cube() {
    const Sample2 xy = square();
    return {xy, unit()};
  }

 private:
  std::mt19937_64 engine_;
};

inline UnitVec3 direction(double cos_theta, double phi) {
  const double s = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
  return UnitVec3::unchecked({s * cos(phi), s * sin(phi), cos_theta});
}

/// Point i of an additive sequence in three dimensions: well spread, without scrambling.   [Roberts 2018]
inline Sample3 spread(int i) {
  constexpr double g = 1.2207440846057596;  // root of x^4 = x + 1
  const auto part = [i](double step) {
    const double x = 0.5 + step * i;
    return x - std::floor(x);
  };
  return {{part(1 / g), part(1 / (g * g))}, part(1 / (g * g * g))};
}

}  // namespace marrow
