// The ending of a name says what is written.
#include "renderer/app/picture/picture_outputs.h"

#include <fmt/core.h>

#include "renderer/app/command_line/files.h"

namespace marrow {

Result<PictureOutputs> choose_outputs(const RenderCommand& command) {
  if (!command.output && !command.png) {
    const auto stem = command.scene.path.stem();
    return PictureOutputs{.exr = stem.string() + ".exr", .png = stem.string() + ".png"};
  }
  PictureOutputs outputs{.exr = {}, .png = command.png};
  if (command.png && command.png->extension() != ".png" && !is_special(*command.png)) {
    return failure(fmt::format("--png writes PNG, but the name is '{}'", command.png->string()));
  }
  if (!command.output) return outputs;
  const auto ending = command.output->extension();
  if (ending == ".exr" || is_special(*command.output)) {
    outputs.exr = command.output;
  } else if (ending != ".png") {
    return failure(
        fmt::format("the output '{}' must be a name with the ending .exr or .png", command.output->string()));
  } else if (command.png) {
    return failure("-o and --png both name a PNG file; -o takes the EXR file then");
  } else {
    outputs.png = command.output;
  }
  return outputs;
}

Diagnostics unwritable(const PictureOutputs& outputs, const std::vector<std::filesystem::path>& inputs) {
  Diagnostics problems;
  for (const auto& path : {outputs.exr, outputs.png}) {
    if (!path) continue;
    auto status = check_apart(*path, inputs);
    if (status) status = check_writable(*path);
    if (!status) problems.push_back(status.why().front());
  }
  return problems;
}

}  // namespace marrow
