// Colours and lines of a slice.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

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

// How far the centres of pixels are from where f = level: between neighbours f is taken to be linear (marching
// squares). Not by |f - level| / |grad f|, which is far too small towards a pole.
class LevelLine {
 public:
  LevelLine(const SliceImage& image, double level, double widest_px)
      : image_(image),
        level_(level),
        reach_(widest_px / 2 + 0.5),
        distance_px_(image.samples.size(), std::numeric_limits<float>::infinity()) {
    for (int y = 0; y + 1 < image.height; ++y)
      for (int x = 0; x + 1 < image.width; ++x) cross(x, y);
  }

  /// Share of the pixel that a line of this width covers, up to the widest.
  double coverage(int x, int y, double width_px) const {
    return std::clamp(width_px / 2 + 0.5 - distance_px_[index(x, y)], 0.0, 1.0);
  }

 private:
  struct Place {
    double x, y;
  };

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x);
  }

  // The square whose upper left corner is this pixel. Where its corners alternate, their mean tells which belong
  // together.
  void cross(int x, int y) {
    constexpr int corners = 4;
    const int cx[corners] = {x, x + 1, x + 1, x}, cy[corners] = {y, y, y + 1, y + 1};
    double f[corners];
    for (int i = 0; i < corners; ++i) f[i] = image_.at(cx[i], cy[i]).value;
    std::array<Place, corners> crossing;
    std::size_t count = 0;
    for (int i = 0; i < corners; ++i) {
      const int next = (i + 1) % corners;
      if (std::isnan(f[i])) return;
      if ((f[i] > level_) == (f[next] > level_)) continue;
      const double t = share(f[i], f[next]);
      crossing[count++] = {cx[i] + t * (cx[next] - cx[i]), cy[i] + t * (cy[next] - cy[i])};
    }
    if (count == 2) return note(crossing[0], crossing[1]);
    if (count != 4) return;
    const bool is_first_alone = ((f[0] + f[1] + f[2] + f[3]) / 4 > level_) != (f[0] > level_);
    note(crossing[0], crossing[is_first_alone ? 3 : 1]);
    note(crossing[2], crossing[is_first_alone ? 1 : 3]);
  }

  // Of the way from one value to the other, up to the level; at a pole all of the way is beside it.
  double share(double from, double to) const {
    if (std::isinf(to)) return 0;
    return std::isinf(from) ? 1 : (level_ - from) / (to - from);
  }

  void note(const Place& a, const Place& b) {
    const auto first = [&](double p, double q) { return std::max(0, static_cast<int>(std::min(p, q) - reach_)); };
    const auto last = [&](double p, double q, int size) {
      return std::min(size - 1, static_cast<int>(std::max(p, q) + reach_) + 1);
    };
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    for (int y = first(a.y, b.y); y <= last(a.y, b.y, image_.height); ++y)
      for (int x = first(a.x, b.x); x <= last(a.x, b.x, image_.width); ++x) {
        const double along = square > 0 ? std::clamp(((x - a.x) * dx + (y - a.y) * dy) / square, 0.0, 1.0) : 0;
        const double d = std::hypot(x - a.x - along * dx, y - a.y - along * dy);
        float& nearest = distance_px_[index(x, y)];
        nearest = std::min(nearest, static_cast<float>(d));
      }
  }

  const SliceImage& image_;
  double level_, reach_;
  std::vector<float> distance_px_;
};

void draw(const LevelLine& line, double width_px, const Color& color, double opacity, RgbImage& onto) {
  for (int y = 0; y < onto.height; ++y)
    for (int x = 0; x < onto.width; ++x)
      if (const double c = line.coverage(x, y, width_px); c > 0) blend(onto, x, y, color, opacity * c);
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
    if (level != image.iso) draw(LevelLine(image, level, scale), scale, white, 0.3, onto);
  const double rim = 5.5 * scale;
  const LevelLine surface(image, image.iso, rim);
  draw(surface, rim, dark, 0.7, onto);
  draw(surface, 3 * scale, white, 1, onto);
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

  // Where colours begin many fields end, and are equal from there on.
  std::vector<double> levels = ticks(range.first, range.second, most_bar_ticks);
  std::erase(levels, range.first);
  RgbImage painted = color_values(image, *map, range);
  draw_lines(image, style.contours ? levels : std::vector<double>{}, painted);
  if (!style.legend) return painted;
  return draw_figure(painted, *map, make_labels(image, style, range));
}

}  // namespace marrow
