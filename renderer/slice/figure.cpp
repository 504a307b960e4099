#include "renderer/slice/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include <cairo.h>

#include "renderer/slice/ticks.h"

namespace marrow {
namespace {

struct Rectangle {
  double x, y, width, height;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

struct TextSize {
  double width, height, bearing_x, bearing_y;
};

// A page of cairo's, with the few strokes that a figure needs. Lengths are pixels.
class Page {
 public:
  Page(int width, int height, double font_px)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy),
        context_(cairo_create(surface_.get()), cairo_destroy) {
    color(1);
    cairo_paint(context_.get());
    cairo_select_font_face(context_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context_.get(), font_px);
  }

  void color(double grey) { cairo_set_source_rgb(context_.get(), grey, grey, grey); }
  void color(const std::array<float, 3>& c) {
    cairo_set_source_rgb(context_.get(), double{c[0]}, double{c[1]}, double{c[2]});
  }
  void fill(const Rectangle& r) {
    cairo_rectangle(context_.get(), r.x, r.y, r.width, r.height);
    cairo_fill(context_.get());
  }
  void outline(const Rectangle& r, double line_px) {
    cairo_set_line_width(context_.get(), line_px);
    cairo_rectangle(context_.get(), r.x, r.y, r.width, r.height);
    cairo_stroke(context_.get());
  }
  void line(double x0, double y0, double x1, double y1, double line_px) {
    cairo_set_line_width(context_.get(), line_px);
    cairo_move_to(context_.get(), x0, y0);
    cairo_line_to(context_.get(), x1, y1);
    cairo_stroke(context_.get());
  }
  void triangle(double x0, double y0, double x1, double y1, double x2, double y2) {
    cairo_move_to(context_.get(), x0, y0);
    cairo_line_to(context_.get(), x1, y1);
    cairo_line_to(context_.get(), x2, y2);
    cairo_close_path(context_.get());
    cairo_fill(context_.get());
  }
  TextSize size(const std::string& text) {
    cairo_text_extents_t e;
    cairo_text_extents(context_.get(), text.c_str(), &e);
    return {e.x_advance, e.height, e.x_bearing, e.y_bearing};
  }
  void text(double x, double baseline, const std::string& text) {
    cairo_move_to(context_.get(), x, baseline);
    cairo_show_text(context_.get(), text.c_str());
  }
  void upward_text(double baseline_x, double center_y, const std::string& text) {
    cairo_save(context_.get());
    cairo_translate(context_.get(), baseline_x, center_y + size(text).width / 2);
    cairo_rotate(context_.get(), -1.5707963267948966);
    this->text(0, 0, text);
    cairo_restore(context_.get());
  }

  void paste(const RgbImage& image, int left, int top);
  RgbImage take();

 private:
  std::uint32_t* row(int y) {
    unsigned char* data = cairo_image_surface_get_data(surface_.get());
    return reinterpret_cast<std::uint32_t*>(data + std::ptrdiff_t{y} * cairo_image_surface_get_stride(surface_.get()));
  }

  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

std::uint32_t code(float v) { return static_cast<std::uint32_t>(std::clamp(v, 0.f, 1.f) * 255 + 0.5f); }

// cairo's RGB24 is one 32-bit number a pixel, blue in the lowest byte.
void Page::paste(const RgbImage& image, int left, int top) {
  cairo_surface_flush(surface_.get());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* p = image.pixel(x, y);
      row(top + y)[left + x] = code(p[0]) << 16 | code(p[1]) << 8 | code(p[2]);
    }
  cairo_surface_mark_dirty(surface_.get());
}

RgbImage Page::take() {
  cairo_surface_flush(surface_.get());
  RgbImage image(cairo_image_surface_get_width(surface_.get()), cairo_image_surface_get_height(surface_.get()));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint32_t c = row(y)[x];
      const auto part = [c](int shift) { return static_cast<float>(c >> shift & 255) / 255; };
      image.set(x, y, {part(16), part(8), part(0)});
    }
  return image;
}

// Where things stand on the page; every length follows from the size of the letters.
struct Layout {
  double font, line;
  Rectangle picture, bar;
  int width, height;
};

// Of one letter in a number, in sizes of the font.
constexpr double letter_width = 0.62;

double step_of(const std::vector<double>& values) { return values.size() > 1 ? values[1] - values[0] : 1; }

// Letters of the longest number; of UTF-8 those bytes count that do not go on.
double longest(const std::vector<double>& values) {
  std::ptrdiff_t most = 0;
  for (const double value : values) {
    const std::string text = label(value, step_of(values));
    most = std::max(most, std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
  }
  return static_cast<double>(most);
}

// As many as find room, their numbers side by side or one below the other, at least two.
std::vector<double> axis_ticks(double low, double high, double length_in_fonts, bool is_side_by_side) {
  constexpr int most_ticks = 8;
  for (int most = most_ticks;; --most) {
    std::vector<double> found = ticks(low, high, most);
    const double each = is_side_by_side ? std::max(4.0, letter_width * longest(found) + 1) : 1.5;
    if (most == 2 || static_cast<double>(found.size()) * each <= length_in_fonts) return found;
  }
}

Layout arrange(const RgbImage& picture, const SliceWindow& window) {
  const double font = std::round(24 * figure_scale(picture.width));
  const double letters = longest(axis_ticks(window.v0, window.v1, picture.height / font, false));
  const double left = std::round(std::max(4.6, letter_width * letters + 2.2) * font), top = std::round(2.2 * font),
               below = std::round(3.8 * font);
  // The colour bar needs room for its letters even beside a low picture
  const double tall = std::max<double>(picture.height, std::round(9 * font));
  const double down = std::round((tall - picture.height) / 2);
  const Rectangle place{left, top + down, double(picture.width), double(picture.height)};
  const double point = std::round(1.2 * font);  // room for the points at the ends of the bar
  const Rectangle bar{std::round(place.right() + 1.2 * font), top + point, font, tall - 2 * point};
  return {font, std::max(1.0, std::round(font / 14)),       place,
          bar,  static_cast<int>(bar.right() + 6.2 * font), static_cast<int>(top + tall + below)};
}

void draw_axes(Page& page, const Layout& at, const FigureLabels& labels) {
  const Rectangle& box = at.picture;
  const double tick = 0.35 * at.font;
  page.color(0);
  page.outline({box.x - at.line / 2, box.y - at.line / 2, box.width + at.line, box.height + at.line}, at.line);

  const SliceWindow& w = labels.window;
  const std::vector<double> us = axis_ticks(w.u0, w.u1, box.width / at.font, true);
  for (const double u : us) {
    const double x = box.x + (u - w.u0) / w.width() * box.width;
    const std::string text = label(u, step_of(us));
    page.line(x, box.bottom(), x, box.bottom() + tick, at.line);
    page.text(x - page.size(text).width / 2, box.bottom() + 1.4 * at.font, text);
  }
  const std::vector<double> vs = axis_ticks(w.v0, w.v1, box.height / at.font, false);
  for (const double v : vs) {
    const double y = box.bottom() - (v - w.v0) / w.height() * box.height;
    const std::string text = label(v, step_of(vs));
    page.line(box.x - tick, y, box.x, y, at.line);
    page.text(box.x - 1.6 * tick - page.size(text).width, y + 0.36 * at.font, text);
  }
  page.text(box.x + (box.width - page.size(labels.u_axis).width) / 2, box.bottom() + 2.9 * at.font, labels.u_axis);
  page.upward_text(1.1 * at.font, box.y + box.height / 2, labels.v_axis);
  page.text(box.x, box.y - 0.7 * at.font, labels.title);
}

void draw_bar_colors(Page& page, const Layout& at, const Colormap& map, const FigureLabels& labels) {
  const Rectangle& bar = at.bar;
  const int rows = static_cast<int>(bar.height);
  for (int i = 0; i < rows; ++i) {
    page.color(map(1 - (i + 0.5) / rows));
    page.fill({bar.x, bar.y + i, bar.width, 1});
  }
  // Points say that the picture holds values beyond the ends
  const double middle = bar.x + bar.width / 2, point = 0.8 * at.font;
  page.color(map(1));
  if (labels.beyond_high) page.triangle(bar.x, bar.y, bar.right(), bar.y, middle, bar.y - point);
  page.color(map(0));
  if (labels.beyond_low) page.triangle(bar.x, bar.y + rows, bar.right(), bar.y + rows, middle, bar.y + rows + point);
}

void draw_bar_labels(Page& page, const Layout& at, const FigureLabels& labels) {
  const Rectangle& bar = at.bar;
  const auto height_of = [&](double value) {
    return bar.bottom() - (value - labels.range.first) / (labels.range.second - labels.range.first) * bar.height;
  };
  const double tick = 0.35 * at.font, iso_y = height_of(labels.iso);
  const bool iso_shown = labels.iso >= labels.range.first && labels.iso <= labels.range.second;
  const int most = std::clamp(static_cast<int>(bar.height / (1.5 * at.font)), 2, most_bar_ticks);
  const std::vector<double> values = ticks(labels.range.first, labels.range.second, most);
  page.color(0);
  for (const double value : values) {
    const double y = height_of(value);
    if (iso_shown && std::fabs(y - iso_y) < 1.3 * at.font) continue;
    page.line(bar.right(), y, bar.right() + tick, y, at.line);
    page.text(bar.right() + 1.6 * tick, y + 0.36 * at.font, label(value, step_of(values)));
  }
  page.text(bar.x + (bar.width - page.size("f").width) / 2, at.bar.y - 1.5 * at.font, "f");
  if (!iso_shown) return;
  page.color(0.08);
  page.line(bar.x, iso_y, bar.right(), iso_y, 3.2 * at.line);
  page.line(bar.right(), iso_y, bar.right() + tick, iso_y, at.line);
  page.text(bar.right() + 1.6 * tick, iso_y + 0.36 * at.font,
            label(labels.iso, 1e-3 * (labels.range.second - labels.range.first)) + " surface");
  page.color(1);
  page.line(bar.x, iso_y, bar.right(), iso_y, 1.6 * at.line);
}

// Lower right, white on a dark rim, so that it shows on every colour.
void draw_scale_bar(Page& page, const Layout& at, const FigureLabels& labels) {
  const Rectangle& box = at.picture;
  if (labels.units.empty() || box.height < 4 * at.font) return;
  const double length = round_length(0.25 * labels.window.width());
  const double pixels = length / labels.window.width() * box.width;
  const std::string text = label(length, length) + " " + labels.units;
  const double x = box.right() - at.font - pixels, y = box.bottom() - 1.1 * at.font, thick = 0.22 * at.font;
  const double text_x = x + (pixels - page.size(text).width) / 2, baseline = y - 0.5 * at.font;
  page.color(0.08);
  page.fill({x - at.line, y - at.line, pixels + 2 * at.line, thick + 2 * at.line});
  for (const double dx : {-1.0, 0.0, 1.0})
    for (const double dy : {-1.0, 0.0, 1.0}) page.text(text_x + dx * at.line, baseline + dy * at.line, text);
  page.color(1);
  page.fill({x, y, pixels, thick});
  page.text(text_x, baseline, text);
}

}  // namespace

double figure_scale(int width) { return std::max(0.5, width / 1024.0); }

RgbImage draw_figure(const RgbImage& picture, const Colormap& map, const FigureLabels& labels) {
  const Layout at = arrange(picture, labels.window);
  Page page(at.width, at.height, at.font);
  page.paste(picture, static_cast<int>(at.picture.x), static_cast<int>(at.picture.y));
  draw_axes(page, at, labels);
  draw_bar_colors(page, at, map, labels);
  draw_bar_labels(page, at, labels);
  draw_scale_bar(page, at, labels);
  return page.take();
}

}  // namespace marrow
