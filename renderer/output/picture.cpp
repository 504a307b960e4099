#include "renderer/output/picture.h"

#include <algorithm>

#include <fmt/format.h>

namespace marrow {
namespace {

template <class T>
std::vector<T> gathered(const std::function<void(int, std::span<T>)>& fill, const PixelWindow& data) {
  const auto width = static_cast<std::size_t>(data.width());
  std::vector<T> samples(width * static_cast<std::size_t>(data.height()));
  for (int y = data.y0; y < data.y1; ++y)
    fill(y, std::span(samples).subspan(static_cast<std::size_t>(y - data.y0) * width, width));
  return samples;
}

}  // namespace

Result<PictureRows> rows_of(const Picture& picture) {
  PictureRows rows{picture.display, picture.data, {}, picture.metadata};
  const auto width = static_cast<std::size_t>(std::max(picture.data.width(), 0));
  const std::size_t pixels = width * static_cast<std::size_t>(std::max(picture.data.height(), 0));
  const auto add = [&]<class T>(const std::string& name, const std::vector<T>& samples) -> Status {
    if (samples.size() != pixels)
      return failure(fmt::format("channel {} has {} samples for {} pixels", name, samples.size(), pixels));
    const auto fill = [&samples, width, y0 = picture.data.y0](int y, std::span<T> row) {
      std::ranges::copy_n(samples.begin() + (y - y0) * static_cast<std::ptrdiff_t>(width),
                          static_cast<std::ptrdiff_t>(width), row.begin());
    };
    rows.channels.push_back({name, std::function<void(int, std::span<T>)>(fill)});
    return Done{};
  };
  for (const Channel& c : picture.channels)
    if (Status added = std::visit([&](const auto& samples) { return add(c.name, samples); }, c.samples); !added)
      return added.why();
  return rows;
}

Picture picture_of(const PictureRows& rows) {
  Picture picture{.display = rows.display, .data = rows.data, .channels = {}, .metadata = rows.metadata};
  for (const ChannelRows& c : rows.channels) {
    const auto gather = [&](const auto& fill) -> decltype(Channel::samples) { return gathered(fill, rows.data); };
    picture.channels.push_back({c.name, std::visit(gather, c.fill)});
  }
  return picture;
}

}  // namespace marrow
