// The reconstruction filter, as a way to choose points around a pixel's middle.
#include "renderer/transport/sampling/pixel_filter.h"

#include <numbers>

#include "field/math/elementary.h"

namespace marrow {
namespace {

// Integral from -radius to -radius + 2 radius t of the four-term window, in units of the whole (the terms of cosines
// integrate to sines and vanish at both ends).   [Harris 1978, minimum 4-term, -92 dB]
double cumulative(double t) {
  constexpr double a0 = 0.35875, a1 = 0.48829, a2 = 0.14128, a3 = 0.01168;
  constexpr double turn = 2 * std::numbers::pi;
  return t - (a1 * sin(turn * t) - a2 / 2 * sin(2 * turn * t) + a3 / 3 * sin(3 * turn * t)) / (turn * a0);
}

}  // namespace

PixelFilter::PixelFilter() {
  for (std::size_t i = 0; i <= steps; ++i) {
    const double target = double(i) / steps;
    double low = 0, high = 1;
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = (low + high) / 2;
      (cumulative(middle) < target ? low : high) = middle;
    }
    inverse_[i] = radius * (low + high - 1);
  }
}

}  // namespace marrow
