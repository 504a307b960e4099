// OpenImageIO behind image_codecs.h: a module, loaded when the first image file is read or written.
#include "renderer/output/image_codecs.h"

#include <cstdint>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace marrow {
namespace {

constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

Status check(const OIIO::ImageSpec& spec) {
  if (spec.deep || spec.depth > 1) return failure("only flat pictures are read");
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) return failure("the picture has no pixels");
  if (std::int64_t{spec.width} * spec.height > most_pixels)
    return failure(fmt::format("{} x {} pixels are more than 2^28", spec.width, spec.height));
  return Done{};
}

Result<DecodedImage> decode(const std::string& path, const std::string& format) {
  const auto input = OIIO::ImageInput::create(format);
  if (!input) return failure("cannot read " + format + " files: " + OIIO::geterror());
  OIIO::ImageSpec spec;
  if (!input->open(path, spec)) return failure("cannot open: " + input->geterror());
  if (Status fine = check(spec); !fine) return fine.why();
  DecodedImage image;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.nchannels >= 3 ? 3 : 1;
  image.encoded = spec.format == OIIO::TypeDesc::UINT8 || spec.format == OIIO::TypeDesc::UINT16;
  image.samples.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                       static_cast<std::size_t>(image.channels));
  if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.samples.data()))
    return failure("cannot read: " + input->geterror());
  return image;
}

Result<std::vector<unsigned char>> encode_png(const PngCodes& codes) {
  const auto depth = codes.bits == 8 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16;
  OIIO::ImageSpec spec(codes.width, codes.height, 3, depth);
  spec.attribute("oiio:ColorSpace", "sRGB");
  for (const auto& [name, value] : codes.text) spec.attribute(name, value);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create("png");
  if (!output) return failure("cannot write PNG files: " + OIIO::geterror());
  output->set_ioproxy(&memory);
  if (!output->open("memory.png", spec) || !output->write_image(depth, codes.samples) || !output->close())
    return failure("cannot encode as PNG: " + output->geterror());
  return bytes;
}

}  // namespace

extern "C" const ImageCodecs* marrow_image_codecs() {
  static constexpr ImageCodecs codecs{decode, encode_png};
  return &codecs;
}

}  // namespace marrow
