// Reading, by OpenEXR's C++ interface.
#include <string>

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include "renderer/output/exr.h"

namespace marrow {
namespace {

using Imath::Box2i;

constexpr std::int64_t most_pixels = std::int64_t{1} << 28;
constexpr std::int64_t most_samples = std::int64_t{1} << 31;

// EXR's windows include their last pixel.
PixelWindow window_of(const Box2i& b) { return {b.min.x, b.min.y, b.max.x + 1, b.max.y + 1}; }

// Where OpenEXR finds pixel (x, y) of a channel: base + x * size + y * width * size with coordinates of the film, so
// that the base of a crop lies before its memory.
Imf::Slice slice_of(Imf::PixelType type, const void* samples, std::size_t size, const PixelWindow& data) {
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(size), width = data.width();
  const std::uintptr_t base =
      reinterpret_cast<std::uintptr_t>(samples) - static_cast<std::uintptr_t>((data.y0 * width + data.x0) * stride);
  return {type, reinterpret_cast<char*>(base), size, size * static_cast<std::size_t>(data.width())};
}

Status check(const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type())) return failure("deep pictures are not read");
  const PixelWindow data = window_of(header.dataWindow());
  const std::int64_t pixels = std::int64_t{data.width()} * data.height();
  std::int64_t samples = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      return failure(fmt::format("channel {} is subsampled", c.name()));
    samples += pixels;
  }
  if (pixels > most_pixels || samples > most_samples)
    return failure(fmt::format("{} x {} pixels are too many", data.width(), data.height()));
  return Done{};
}

std::vector<std::pair<std::string, Metadata>> read_metadata(const Imf::Header& header) {
  std::vector<std::pair<std::string, Metadata>> metadata;
  for (auto a = header.begin(); a != header.end(); ++a) {
    const std::string name = a.name();
    if (name == "type") continue;  // of the part, not of the picture
    if (auto s = dynamic_cast<const Imf::StringAttribute*>(&a.attribute())) metadata.emplace_back(name, s->value());
    if (auto i = dynamic_cast<const Imf::IntAttribute*>(&a.attribute())) metadata.emplace_back(name, i->value());
    if (auto d = dynamic_cast<const Imf::DoubleAttribute*>(&a.attribute())) metadata.emplace_back(name, d->value());
  }
  return metadata;
}

Result<Picture> decode(Imf::InputFile& file) {
  const Imf::Header& header = file.header();
  if (Status fine = check(header); !fine) return fine.why();
  Picture picture{.display = window_of(header.displayWindow()),
                  .data = window_of(header.dataWindow()),
                  .channels = {},
                  .metadata = read_metadata(header)};
  const std::size_t pixels =
      static_cast<std::size_t>(picture.data.width()) * static_cast<std::size_t>(picture.data.height());
  Imf::FrameBuffer buffer;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().type == Imf::UINT) {
      std::vector<std::uint32_t> samples(pixels);
      buffer.insert(c.name(), slice_of(Imf::UINT, samples.data(), sizeof(std::uint32_t), picture.data));
      picture.channels.push_back({c.name(), std::move(samples)});
    } else {
      std::vector<float> samples(pixels);
      buffer.insert(c.name(), slice_of(Imf::FLOAT, samples.data(), sizeof(float), picture.data));
      picture.channels.push_back({c.name(), std::move(samples)});
    }
  }
  file.setFrameBuffer(buffer);
  file.readPixels(picture.data.y0, picture.data.y1 - 1);  // throws when lines are missing
  return picture;
}

}  // namespace

Result<Picture> read_exr(const std::filesystem::path& path) {
  try {
    // Before any table as long as the claimed height is allocated
    Imf::Header::setMaxImageSize(1 << 20, 1 << 20);
    Imf::InputFile file(path.c_str());
    Result<Picture> picture = decode(file);
    if (picture) return picture;
    Diagnostics why = picture.why();
    for (Diagnostic& d : why) d.where.file = path.string();
    return why;
  } catch (const std::exception& e) { return failure(std::string("cannot read: ") + e.what(), path.string()); }
}

}  // namespace marrow
