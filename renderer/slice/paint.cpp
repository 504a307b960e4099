// Colours and lines of a slice.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "renderer/output/colormap.h"
#include "renderer/slice/figure.h"
#include "renderer/slice/slice.h"
#include "renderer/slice/ticks.h"

namespace marrow {
namespace {

using Color = std::array<float, 3>;

constexpr Color white{1, 1, 1}, dark{0.08f, 0.08f, 0.1f};
constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

void blend(RgbImage& image, int x, int y, const Color& over, double coverage) {
  float* p = image.pixel(x, y);
  for (std::size_t k = 0; k < 3; ++k) p[k] = static_cast<float>(p[k] + (over[k] - p[k]) * coverage);
}

// A line of constant width where f = level.
class LevelLine {
 public:
  LevelLine(const SliceImage& image, double level, double width_px)
      : image_(image), level_(level), half_width_(width_px / 2), reach_(static_cast<int>(std::ceil(half_width_ + 1))) {}

  /// Share of the pixel that the line covers.
  double coverage(int x, int y) const {
    const double d = distance_px(x, y);
    // |f - level| / |grad f| is small near a pole of the field as well, where no level is crossed
    if (!(d < half_width_ + 0.5) || !crossed_near(x, y)) return 0;
    return std::clamp(half_width_ + 0.5 - d, 0.0, 1.0);
  }

 private:
  // To first order, by the part of the gradient that lies in the plane.
  double distance_px(int x, int y) const {
    const auto [u, v] = slice_axes(image_.axis);
    const SliceSample& s = image_.at(x, y);
    const double gu = s.gradient[static_cast<std::size_t>(u)], gv = s.gradient[static_cast<std::size_t>(v)];
    return std::fabs(s.value - level_) / (std::sqrt(gu * gu + gv * gv) * image_.units_per_pixel());
  }

  bool crossed_near(int x, int y) const {
    const bool above = image_.at(x, y).value > level_;
    for (int j = std::max(0, y - reach_); j <= std::min(image_.height - 1, y + reach_); ++j)
      for (int i = std::max(0, x - reach_); i <= std::min(image_.width - 1, x + reach_); ++i)
        if ((image_.at(i, j).value > level_) != above) return true;
    return false;
  }

  const SliceImage& image_;
  double level_, half_width_;
  int reach_;
};

void draw(const LevelLine& line, const Color& color, double opacity, RgbImage& onto) {
  for (int y = 0; y < onto.height; ++y)
    for (int x = 0; x < onto.width; ++x)
      if (const double c = line.coverage(x, y); c > 0) blend(onto, x, y, color, opacity * c);
}

RgbImage color_values(const SliceImage& image, const Colormap& map, const std::pair<double, double>& range) {
  RgbImage painted(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      painted.set(x, y, map((image.at(x, y).value - range.first) / (range.second - range.first)));
  return painted;
}

void draw_lines(const SliceImage& image, const std::vector<double>& levels, RgbImage& onto) {
  const double scale = figure_scale(image.width);
  for (const double level : levels)
    if (level != image.iso) draw(LevelLine(image, level, scale), white, 0.3, onto);
  draw(LevelLine(image, image.iso, 5.5 * scale), dark, 0.7, onto);
  draw(LevelLine(image, image.iso, 3 * scale), white, 1, onto);
}

FigureLabels make_labels(const SliceImage& image, const SliceStyle& style, const std::pair<double, double>& range) {
  const auto [u, v] = slice_axes(image.axis);
  const std::string suffix = style.units.empty() ? "" : " (" + style.units + ")";
  const auto name = [](int axis) { return std::string(axis_names[static_cast<std::size_t>(axis)]); };
  FigureLabels labels{.window = image.window,
                      .title = name(image.axis) + " = " + label(image.offset, 1e-3 * image.window.width()),
                      .u_axis = name(u) + suffix,
                      .v_axis = name(v) + suffix,
                      .units = style.units,
                      .range = range,
                      .iso = image.iso};
  if (!style.units.empty()) labels.title += " " + style.units;
  for (const SliceSample& s : image.samples) {
    labels.beyond_low = labels.beyond_low || s.value < range.first;
    labels.beyond_high = labels.beyond_high || s.value > range.second;
  }
  return labels;
}

}  // namespace

Result<RgbImage> paint(const SliceImage& image, const SliceStyle& style) {
  const Result<Colormap> map = Colormap::named(style.colormap);
  if (!map) return map.why();
  const std::pair<double, double> range = style.range ? *style.range : automatic_range(image);
  if (!(range.second > range.first) || !std::isfinite(range.second - range.first))
    return failure(fmt::format("the range of colours {} to {} is empty or not finite", range.first, range.second));

  const std::vector<double> levels = ticks(range.first, range.second, most_bar_ticks);
  RgbImage painted = color_values(image, *map, range);
  draw_lines(image, style.contours ? levels : std::vector<double>{}, painted);
  if (!style.legend) return painted;
  return draw_figure(painted, *map, make_labels(image, style, range));
}

}  // namespace marrow
