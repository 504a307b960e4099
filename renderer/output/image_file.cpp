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

#include <fmt/format.h>

#include "field/math/elementary.h"
#include "renderer/output/atomic_file.h"
#include "renderer/output/image_codecs.h"

namespace marrow {
namespace {

namespace fs = std::filesystem;

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
  return with_hint(failure(fmt::format("pixel ({}, {}) is not finite", pixel % image.width, pixel / image.width)),
                   "mend it first: oiiotool in.exr --fixnan box3 -o out.exr");
}

Result<RgbImage> open_and_decode(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return failure("no such file");
  if (!fs::is_regular_file(status)) return failure("not a regular file");
  const std::optional<std::string> format = format_of(path);
  if (!format) return failure("not an EXR, HDR, PNG, JPEG or TIFF file");
  const auto codecs = image_codecs();
  if (!codecs) return codecs.why();
  auto decoded = (*codecs)->decode(path.string(), *format);
  if (!decoded) return decoded.why();
  auto& samples = decoded->samples;
  if (decoded->encoded) std::transform(samples.begin(), samples.end(), samples.begin(), linear_from_srgb);
  RgbImage image = three_channels(decoded->width, decoded->height, decoded->channels, std::move(samples));
  if (Status fine = check_finite(image); !fine) return fine.why();
  return image;
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

Result<std::vector<unsigned char>> encoded_as_png(PngCodes codes, const RgbImage& image) {
  const auto codecs = image_codecs();
  if (!codecs) return codecs.why();
  if (codes.bits == 8) {
    const auto samples = quantize<std::uint8_t>(image);
    codes.samples = samples.data();
    return (*codecs)->encode_png(codes);
  }
  const auto samples = quantize<std::uint16_t>(image);
  codes.samples = samples.data();
  return (*codecs)->encode_png(codes);
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
  PngCodes codes{.width = image.width, .height = image.height, .bits = static_cast<int>(depth), .text = text};
  codes.text.insert(codes.text.begin(), {"Software", "marrow " MARROW_VERSION});
  const auto bytes = encoded_as_png(std::move(codes), image);
  if (!bytes) {
    Diagnostics why = bytes.why();
    for (Diagnostic& d : why) d.where.file = path.string();
    return why;
  }
  return write_file_atomically(path, std::as_bytes(std::span(*bytes)));
}

}  // namespace marrow
