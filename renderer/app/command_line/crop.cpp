// From the text of --crop to a window of pixels.
#include "renderer/app/command_line/crop.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/core.h>

#include "renderer/app/text/text.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

std::optional<Crop::Coordinate> parse_coordinate(std::string_view text) {
  const bool percent = !text.empty() && text.back() == '%';
  if (percent) text.remove_suffix(1);
  const auto value = finite_number(text);
  // Beyond 2^30 no film reaches, and a pixel count must fit an int.
  if (!value || std::fabs(*value) > 1 << 30 || (!percent && *value != std::floor(*value))) return std::nullopt;
  return Crop::Coordinate{*value, percent};
}

int pixels(const Crop::Coordinate& c, int size) {
  const double edge = c.percent ? std::floor(c.value / 100 * size + 0.5) : c.value;
  return static_cast<int>(std::clamp(edge, 0.0, static_cast<double>(size)));
}

}  // namespace

Result<Crop> parse_crop(const std::string& text) {
  const auto parts = split(text, ',');
  Crop crop;
  bool good = parts.size() == crop.corners.size();
  for (std::size_t i = 0; good && i < parts.size(); ++i) {
    const auto coordinate = parse_coordinate(parts[i]);
    good = coordinate.has_value();
    if (good) crop.corners[i] = *coordinate;
  }
  if (good) return crop;
  return failure(fmt::format("a crop is x0,y0,x1,y1 in pixels or percent, such as 0,0,50%,50%; found '{}'", text));
}

Result<PixelWindow> resolve(const Crop& crop, int width, int height) {
  const auto& c = crop.corners;
  const PixelWindow window{pixels(c[0], width), pixels(c[1], height), pixels(c[2], width), pixels(c[3], height)};
  if (window.width() > 0 && window.height() > 0) return window;
  return failure(fmt::format("the crop holds no pixel of the film, which has {} x {}", width, height));
}

}  // namespace marrow
