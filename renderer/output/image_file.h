// Image files of the common kinds: environment maps in, PNG out.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "field/base/result.h"
#include "renderer/output/picture.h"
#include "renderer/output/rgb_image.h"

namespace marrow {

/// Scene-linear red, green, blue of an EXR, HDR (Radiance), PNG, JPEG or TIFF file. 8- and 16-bit files are taken as
/// sRGB and made linear; grey files give three equal channels; alpha is dropped. The primaries are not converted.
/// Refuses other kinds of file, more than 2^28 pixels, and pixels that are not finite.
Result<RgbImage> read_rgb_image(const std::filesystem::path&);

enum class PngDepth { Bits8 = 8, Bits16 = 16 };

/// Writes display-encoded values: 0 -> 0, 1 -> the largest code, rounded to nearest and clamped; NaN becomes magenta.
/// `text` goes into tEXt chunks. The file replaces an old one as write_file_atomically does.
Status write_png(const std::filesystem::path&, const RgbImage&, PngDepth = PngDepth::Bits8,
                 const std::vector<std::pair<std::string, std::string>>& text = {});

}  // namespace marrow
