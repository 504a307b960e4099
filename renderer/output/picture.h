// A picture in memory, as it goes to a file: named channels over a window, and metadata.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "field/base/result.h"

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

/// Fill the samples of the row y of the data window, for any threads at once.
using FloatRow = std::function<void(int y, std::span<float>)>;
using WholeRow = std::function<void(int y, std::span<std::uint32_t>)>;

struct ChannelRows {
  std::string name;
  std::variant<FloatRow, WholeRow> fill;
};

/// A picture that is made row by row as it goes to a file, from what its functions refer to.
struct PictureRows {
  PixelWindow display;
  PixelWindow data;
  std::vector<ChannelRows> channels;
  std::vector<std::pair<std::string, Metadata>> metadata;
};

/// A picture in memory as one that is made row by row, from the picture itself, which must outlive it; an error if a
/// channel has too few samples or too many.
Result<PictureRows> rows_of(const Picture&);
/// All rows, in memory.
Picture picture_of(const PictureRows&);

}  // namespace marrow
