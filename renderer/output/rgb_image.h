// Red, green, blue in memory, without a promise about their encoding.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace marrow {

/// Row by row from the top, three floats a pixel. Who makes one says if it is scene-linear or display-encoded.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<float> samples;

  RgbImage() = default;
  RgbImage(int w, int h)
      : width(w), height(h), samples(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  float* pixel(int x, int y) { return samples.data() + offset(x, y); }
  const float* pixel(int x, int y) const { return samples.data() + offset(x, y); }
  void set(int x, int y, const std::array<float, 3>& rgb) {
    for (std::size_t i = 0; i < 3; ++i) samples[offset(x, y) + i] = rgb[i];
  }

 private:
  std::size_t offset(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

}  // namespace marrow
