// A picture in memory, as it goes to a file: named channels over a window, and metadata.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace marrow {

/// Pixels x0 <= x < x1, y0 <= y < y1; y counts downward.
struct PixelWindow {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  friend bool operator==(const PixelWindow&, const PixelWindow&) = default;
};

/// Row-major over the picture's data window. EXR stores float as 32 bit, unsigned as UINT.
struct Channel {
  std::string name;
  std::variant<std::vector<float>, std::vector<std::uint32_t>> samples;
};

using Metadata = std::variant<std::string, int, double>;

struct Picture {
  PixelWindow display;  ///< the whole film
  PixelWindow data;     ///< what was rendered: the film or a crop of it
  std::vector<Channel> channels;
  std::vector<std::pair<std::string, Metadata>> metadata;
};

}  // namespace marrow
