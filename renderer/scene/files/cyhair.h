// Hair in the binary format of cyHair (.hair).
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/files/skeleton_options.h"

namespace marrow {

/// The strands of a cyHair file, each from root to tip. The thickness of the file is a diameter. Colours and
/// transparency are left out. Files of machines with the other byte order are read as well. Errors: no cyHair file;
/// arrays that the file is too short for; strands that do not add up to the points; numbers that are not finite.
/// [format: C. Yuksel, "HAIR File Format Specification", cemyuksel.com/research/hairmodels]
Result<SkeletonFile> read_cyhair(std::string_view bytes, const SkeletonOptions&, const std::string& name);

}  // namespace marrow
