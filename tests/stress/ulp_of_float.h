// The distance from a number to the next one of floats.
#pragma once

#include <cmath>
#include <limits>

namespace marrow::test {

inline double ulp_of_float(double t) {
  const auto f = static_cast<float>(t);
  return static_cast<double>(std::nextafter(f, std::numeric_limits<float>::infinity()) - f);
}

}  // namespace marrow::test
