#include "renderer/output/image_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "field/math/elementary.h"
#include "renderer/output/atomic_file.h"

namespace marrow {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

// ---- reading ----

// OIIO picks a reader by trying them all, old and rarely tested ones too; we name the reader by the first bytes.
std::optional<std::string> format_of(const fs::path& path) {
  using namespace std::string_view_literals;
  constexpr std::pair<std::string_view, const char*> kinds[] = {
      {"\x76\x2f\x31\x01"sv, "openexr"}, {"#?"sv, "hdr"},     {"\x89PNG\r\n\x1a\n"sv, "png"},
      {"\xff\xd8\xff"sv, "jpeg"},        {"II*\0"sv, "tiff"}, {"MM\0*"sv, "tiff"},
  };
  std::array<char, 8> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  const std::string_view start(head.data(), head.size());
  for (const auto& [magic, name] : kinds)
    if (start.starts_with(magic)) return name;
  return {};
}

Status check(const OIIO::ImageSpec& spec) {
  if (spec.deep || spec.depth > 1) return failure("only flat pictures are read");
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) return failure("the picture has no pixels");
  if (std::int64_t{spec.width} * spec.height > most_pixels)
    return failure(fmt::format("{} x {} pixels are more than 2^28", spec.width, spec.height));
  return Done{};
}

// IEC 61966-2-1, the inverse of its transfer function.
float linear_from_srgb(float v) {
  return v <= 0.04045f ? v / 12.92f : static_cast<float>(pow((double{v} + 0.055) / 1.055, 2.4));
}

RgbImage three_channels(int width, int height, int channels, std::vector<float> samples) {
  RgbImage image;
  image.width = width;
  image.height = height;
  if (channels == 3) {
    image.samples = std::move(samples);
  } else {
    image.samples.reserve(3 * samples.size());
    for (const float grey : samples) image.samples.insert(image.samples.end(), 3, grey);
  }
  return image;
}

Status check_finite(const RgbImage& image) {
  const auto bad = std::find_if(image.samples.begin(), image.samples.end(), [](float v) { return !std::isfinite(v); });
  if (bad == image.samples.end()) return Done{};
  const auto pixel = (bad - image.samples.begin()) / 3;
  Diagnostic d = failure(fmt::format("pixel ({}, {}) is not finite", pixel % image.width, pixel / image.width));
  d.hint = "mend it first: oiiotool in.exr --fixnan box3 -o out.exr";
  return d;
}

Result<RgbImage> decode(OIIO::ImageInput& input, const OIIO::ImageSpec& spec) {
  if (Status fine = check(spec); !fine) return fine.why();
  const int channels = spec.nchannels >= 3 ? 3 : 1;
  std::vector<float> samples(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                             static_cast<std::size_t>(channels));
  if (!input.read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, samples.data()))
    return failure("cannot read: " + input.geterror());
  const bool encoded = spec.format == OIIO::TypeDesc::UINT8 || spec.format == OIIO::TypeDesc::UINT16;
  if (encoded) std::transform(samples.begin(), samples.end(), samples.begin(), linear_from_srgb);
  RgbImage image = three_channels(spec.width, spec.height, channels, std::move(samples));
  if (Status fine = check_finite(image); !fine) return fine.why();
  return image;
}

Result<RgbImage> open_and_decode(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return failure("no such file");
  if (!fs::is_regular_file(status)) return failure("not a regular file");
  const std::optional<std::string> format = format_of(path);
  if (!format) return failure("not an EXR, HDR, PNG, JPEG or TIFF file");
  const auto input = OIIO::ImageInput::create(*format);
  if (!input) return failure("cannot read " + *format + " files: " + OIIO::geterror());
  OIIO::ImageSpec spec;
  if (!input->open(path.string(), spec)) return failure("cannot open: " + input->geterror());
  return decode(*input, spec);
}

// ---- writing ----

constexpr float magenta[3] = {1, 0, 1};

template <class Code>
std::vector<Code> quantize(const RgbImage& image) {
  constexpr double top = std::numeric_limits<Code>::max();
  std::vector<Code> codes(image.samples.size());
  for (std::size_t i = 0; i < codes.size(); i += 3) {
    const float* p = image.samples.data() + i;
    const bool nan = std::isnan(p[0]) || std::isnan(p[1]) || std::isnan(p[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = nan ? magenta[k] : p[k];
      codes[i + k] = static_cast<Code>(std::floor(std::clamp(v, 0.0, 1.0) * top + 0.5));
    }
  }
  return codes;
}

OIIO::ImageSpec png_spec(const RgbImage& image, PngDepth depth,
                         const std::vector<std::pair<std::string, std::string>>& text) {
  OIIO::ImageSpec spec(image.width, image.height, 3,
                       depth == PngDepth::Bits8 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("Software", "marrow " MARROW_VERSION);
  for (const auto& [name, value] : text) spec.attribute(name, value);
  return spec;
}

}  // namespace

Result<RgbImage> read_rgb_image(const fs::path& path) {
  Result<RgbImage> image = open_and_decode(path);
  if (image) return image;
  Diagnostics why = image.why();
  for (Diagnostic& d : why) d.where.file = path.string();
  return why;
}

Status write_png(const fs::path& path, const RgbImage& image, PngDepth depth,
                 const std::vector<std::pair<std::string, std::string>>& text) {
  if (image.width <= 0 || image.height <= 0) return failure("the picture has no pixels", path.string());
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create("png");
  if (!output) return failure("cannot write PNG files: " + OIIO::geterror(), path.string());
  output->set_ioproxy(&memory);
  const bool small = depth == PngDepth::Bits8;
  const bool written = output->open("memory.png", png_spec(image, depth, text)) &&
                       (small ? output->write_image(OIIO::TypeDesc::UINT8, quantize<std::uint8_t>(image).data())
                              : output->write_image(OIIO::TypeDesc::UINT16, quantize<std::uint16_t>(image).data())) &&
                       output->close();
  if (!written) return failure("cannot encode as PNG: " + output->geterror(), path.string());
  return write_file_atomically(path, std::as_bytes(std::span(bytes)));
}

}  // namespace marrow
