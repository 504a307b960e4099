// The reconstruction filter, as a way to choose points around a pixel's middle.
#pragma once

#include <array>
#include <cstddef>

#include "materials/sample.h"

namespace marrow {

/// Blackman-Harris, separable, 1.5 pixels to each side. A sample is drawn with the filter's density and counts fully
/// for its pixel and for no other.   [filter: Harris 1978; use: Ernst, Stamminger, Greiner 2006]
class PixelFilter {
 public:
  static constexpr double radius = 1.5;

  PixelFilter();
  /// From a point of the unit square to an offset from the pixel's middle, pixels.
  Sample2 offset(Sample2 u) const { return {along(u.x), along(u.y)}; }

 private:
  static constexpr std::size_t steps = 256;
  // The inverse of the cumulative filter, linear between equal steps of probability.
  double along(double u) const {
    const double x = u * steps;
    const auto i = static_cast<std::size_t>(x);
    return inverse_[i] + (inverse_[i + 1] - inverse_[i]) * (x - double(i));
  }

  std::array<double, steps + 1> inverse_{};
};

}  // namespace marrow
