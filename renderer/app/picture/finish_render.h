// The end of a render: from the film to the files, and what is to be said about them.
#pragma once

#include <optional>

#include "renderer/app/command_line/exit_code.h"
#include "renderer/app/picture/picture_outputs.h"
#include "renderer/app/report/progress_line.h"
#include "renderer/output/display.h"
#include "renderer/output/picture.h"
#include "renderer/scene/scene_description.h"
#include "renderer/transport/film/film.h"

namespace marrow {

/// What the command line asks for besides the scene, found good before the work begins.
struct Preparation {
  PictureOutputs outputs;
  std::optional<Display> display;  ///< when there is a PNG to write
  std::optional<PixelWindow> crop;
};

/// Writes the outputs, also those of an interrupted render, and warns of what makes the picture doubtful: with
/// `strict` that is an exit code of its own.
ExitCode finish(const Film&, const SceneDescription&, const RenderSettings&, const Preparation&, bool strict,
                ProgressLine&);

}  // namespace marrow
