// Pictures as OpenEXR files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "field/base/result.h"
#include "renderer/output/picture.h"

namespace marrow {

enum class ExrColor {
  Float,  ///< every channel in 32 bits
  Half,   ///< R G B A and albedo in 16 bits, clamped to +-65504; everything else stays exact
};

/// One flat part, ZIP compression, rows from the top. Besides Picture::metadata, where an entry of the same name
/// wins, the header holds
///   Software         "marrow <version>"
///   capDate          $SOURCE_DATE_EPOCH, or the current time in UTC when that is not set
///   colorInteropID   lin_rec709_scene if there is a channel R, else data
///   chromaticities   those of lin_rec709_scene or lin_ap1_scene when colorInteropID is one of them
/// The same picture gives the same bytes for any number of threads when SOURCE_DATE_EPOCH is set.
Result<std::vector<std::byte>> encode_exr(const PictureRows&, ExrColor = ExrColor::Float);
Result<std::vector<std::byte>> encode_exr(const Picture&, ExrColor = ExrColor::Float);

/// encode_exr onto write_file_atomically: after an error the old file is as it was.
Status write_exr(const std::filesystem::path&, const PictureRows&, ExrColor = ExrColor::Float);
Status write_exr(const std::filesystem::path&, const Picture&, ExrColor = ExrColor::Float);

/// Reads what write_exr wrote, and any other flat EXR: channels in the order of the file (by name), half widened to
/// float; string, int and double attributes as metadata, so that a picture read can be written again. Refuses files cut
/// short and pictures beyond 2^28 pixels or 2^31 samples.
Result<Picture> read_exr(const std::filesystem::path&);

}  // namespace marrow
