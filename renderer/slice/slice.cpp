#include "renderer/slice/slice.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace marrow {
namespace {

constexpr double most_pixels = double{1 << 26};
constexpr std::array<char, 3> axis_names = {'x', 'y', 'z'};

std::size_t index(int axis) { return static_cast<std::size_t>(axis); }

// A quarter of the object's size on each side; a flat object gets a quarter of its longest side instead.
Result<SliceWindow> default_window(const Box3& bounds, int axis) {
  if (bounds.empty() || !is_finite(bounds.size())) {
    return with_hint(failure("the object has no bounds to fit the picture to"), "give a window");
  }
  const auto [u, v] = slice_axes(axis);
  const double longest = max_component(bounds.size());
  const auto margin = [&](int a) {
    const double size = bounds.size()[index(a)];
    return 0.25 * (size > 0 ? size : longest > 0 ? longest : 1);
  };
  const Vec3d &lower = bounds.lower, &upper = bounds.upper;
  return SliceWindow{lower[index(u)] - margin(u), lower[index(v)] - margin(v), upper[index(u)] + margin(u),
                     upper[index(v)] + margin(v)};
}

Result<SliceImage> blank(double iso, const Box3& bounds, const SliceRequest& request) {
  if (request.axis < 0 || request.axis > 2) return failure("the axis of a slice is 0, 1 or 2");
  if (!std::isfinite(request.offset)) return failure("the offset of the plane is not finite");
  const Result<SliceWindow> window = request.window ? *request.window : default_window(bounds, request.axis);
  if (!window) return window.why();
  const double aspect = window->height() / window->width();
  if (!(window->width() > 0) || !(aspect > 0) || !std::isfinite(aspect))
    return failure("the window of the slice is empty or not finite");
  const double height = std::max(1.0, std::floor(request.width * aspect + 0.5));
  if (request.width < 1 || request.width * height > most_pixels) {
    const double widest = std::min(std::floor(std::sqrt(most_pixels / aspect)), most_pixels);
    return with_hint(failure(fmt::format("{} x {:.0f} pixels: a slice has from 1 to 2^26", request.width, height)),
                     widest >= 1 ? fmt::format("a width of {:.0f} fits this window", widest) : "");
  }
  SliceImage image{.axis = request.axis,
                   .offset = request.offset,
                   .iso = iso,
                   .window = *window,
                   .width = request.width,
                   .height = static_cast<int>(height),
                   .samples = {}};
  image.samples.resize(index(image.width) * index(image.height));
  return image;
}

Vec3d pixel_center(const SliceImage& image, int x, int y) {
  const auto [u, v] = slice_axes(image.axis);
  Vec3d p;
  p[index(image.axis)] = image.offset;
  p[index(u)] = image.window.u0 + (x + 0.5) / image.width * image.window.width();
  p[index(v)] = image.window.v1 - (y + 0.5) / image.height * image.window.height();
  return p;
}

// Some pixels of an image.
struct Part {
  int x0, y0, x1, y1;  // the last two are beyond it

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  // Halves along each side that is longer than a square of pixels.
  std::vector<Part> divided(int square) const {
    const int xm = width() > square ? x0 + width() / 2 : x1, ym = height() > square ? y0 + height() / 2 : y1;
    std::vector<Part> parts;
    for (const auto& [top, bottom] : {std::pair{y0, ym}, std::pair{ym, y1}})
      for (const auto& [left, right] : {std::pair{x0, xm}, std::pair{xm, x1}})
        if (left < right && top < bottom) parts.push_back({left, top, right, bottom});
    return parts;
  }
};

Box3 box_of(const SliceImage& image, const Part& part) {
  Box3 box;
  box.include(pixel_center(image, part.x0, part.y0));
  box.include(pixel_center(image, part.x1 - 1, part.y1 - 1));
  return box;
}

// From part to part, each with the field in a box around its pixels: the same numbers on any number of threads.
class Sampler {
 public:
  Sampler(SliceImage& image, const std::atomic<bool>* interrupted) : image_(image), interrupted_(interrupted) {}

  void sample(const SliceField& field, const Part& part) const {
    const std::vector<Part> parts = part.divided(square);
    if (parts.size() == 1) return sample_pixels(field, part);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      if (is_over()) return;
      if (field.within) sample(field.within(box_of(image_, parts[i])), parts[i]);
      else sample(field, parts[i]);
    });
  }

 private:
  // Of pixels that go on with one field: smaller ones gain less than it takes to make theirs.
  static constexpr int square = 16;

  bool is_over() const { return interrupted_ != nullptr && interrupted_->load(std::memory_order_relaxed); }

  void sample_pixels(const SliceField& field, const Part& part) const {
    for (int y = part.y0; y < part.y1; ++y)
      for (int x = part.x0; x < part.x1 && !is_over(); ++x)
        image_.samples[index(y) * index(image_.width) + index(x)] = field.at(pixel_center(image_, x, y));
  }

  SliceImage& image_;
  const std::atomic<bool>* interrupted_;
};

Channel channel(const std::string& name, const SliceImage& image, const std::function<double(const SliceSample&)>& of) {
  std::vector<float> values(image.samples.size());
  std::transform(image.samples.begin(), image.samples.end(), values.begin(),
                 [&](const SliceSample& s) { return static_cast<float>(of(s)); });
  return {name, std::move(values)};
}

}  // namespace

Result<std::pair<int, double>> parse_plane(const std::string& text) {
  std::string packed;
  std::copy_if(text.begin(), text.end(), std::back_inserter(packed), [](char c) { return c != ' '; });
  const auto axis = packed.empty() ? axis_names.end() : std::find(axis_names.begin(), axis_names.end(), packed[0]);
  double offset = 0;
  const char* const last = packed.data() + packed.size();
  const bool shaped = packed.size() > 2 && axis != axis_names.end() && packed[1] == '=';
  if (shaped) {
    const auto [end, error] = std::from_chars(packed.data() + 2, last, offset);
    if (error == std::errc{} && end == last && std::isfinite(offset))
      return std::pair(static_cast<int>(axis - axis_names.begin()), offset);
  }
  return with_hint(failure("\"" + text + "\" is not an axis plane"), "for example z=0 or x=-1.5");
}

std::array<int, 2> slice_axes(int axis) {
  constexpr std::array<std::array<int, 2>, 3> axes = {{{1, 2}, {0, 2}, {0, 1}}};
  return axes[index(axis)];
}

Result<SliceImage> slice(const SliceField& field, double iso, const Box3& bounds, const SliceRequest& request) {
  Result<SliceImage> image = blank(iso, bounds, request);
  if (!image) return image;
  const auto sample = [&] { Sampler(*image, request.interrupted).sample(field, {0, 0, image->width, image->height}); };
  if (request.threads > 0) tbb::task_arena(request.threads).execute(sample);
  else sample();
  return image;
}

std::pair<double, double> automatic_range(const SliceImage& image) {
  double low = 0;
  for (const SliceSample& s : image.samples)
    if (s.value < low && std::isfinite(s.value)) low = s.value;
  // As far below the surface as above it: beyond that negative fields are as unbounded as positive ones
  low = std::max(low, image.iso - 2 * std::max(std::fabs(image.iso), 1e-300));
  const double high = image.iso > 0 ? 2 * image.iso : image.iso - low;
  return high > low ? std::pair(low, high) : std::pair(image.iso - 1, image.iso + 1);
}

Picture to_exr_picture(const SliceImage& image) {
  const PixelWindow all{0, 0, image.width, image.height};
  Picture picture{.display = all, .data = all, .channels = {}, .metadata = {}};
  picture.channels.push_back(channel("field.grad.X", image, [](const SliceSample& s) { return s.gradient.x; }));
  picture.channels.push_back(channel("field.grad.Y", image, [](const SliceSample& s) { return s.gradient.y; }));
  picture.channels.push_back(channel("field.grad.Z", image, [](const SliceSample& s) { return s.gradient.z; }));
  picture.channels.push_back(channel("field.value", image, [](const SliceSample& s) { return s.value; }));
  picture.metadata = {{"marrow/slicePlane", fmt::format("{}={}", axis_names[index(image.axis)], image.offset)},
                      {"marrow/sliceU0", image.window.u0},
                      {"marrow/sliceV0", image.window.v0},
                      {"marrow/sliceU1", image.window.u1},
                      {"marrow/sliceV1", image.window.v1},
                      {"marrow/iso", image.iso}};
  return picture;
}

}  // namespace marrow
