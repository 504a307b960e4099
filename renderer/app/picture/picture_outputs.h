// Where the pictures of a render go.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "field/base/result.h"
#include "renderer/app/command_line/commands.h"

namespace marrow {

struct PictureOutputs {
  std::optional<std::filesystem::path> exr, png;
};

/// What -o and --png ask for; when neither is given, the scene's stem with .exr and .png in the current folder.
/// Errors: an ending that is neither .exr nor .png; two PNG files.
Result<PictureOutputs> choose_outputs(const RenderCommand&);

/// Every output that cannot be written, or is one of these files, which the scene is made from.
Diagnostics unwritable(const PictureOutputs&, const std::vector<std::filesystem::path>& inputs);

}  // namespace marrow
