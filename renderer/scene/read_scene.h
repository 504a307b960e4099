// From the text of a scene and the files it names to a SceneDescription, or to all that is wrong with it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "field/base/diagnostics.h"
#include "field/base/result.h"
#include "renderer/scene/scene_description.h"
#include "renderer/scene/source_cache.h"

namespace marrow {

struct ReadOptions {
  /// `path.to.value=text`, as -D gives them; the text is a piece of YAML. Items of a list are named by their
  /// index from 0 or, where they have one, by their name: `objects.creature.field.blend.alpha=0.9`.
  /// Checked like the file itself; mistakes are placed in a text called "-D", one override a line.
  std::vector<std::string> overrides;
  /// When false every file that the scene names must lie under the scene's folder (scenes of strangers).
  /// Files of /proc, /sys and /dev are refused always, and so is all that is not a regular file.
  bool allow_outside = true;
};

/// What reading leaves behind besides the scene, also when it fails.
struct ReadRecord {
  SourceCache sources;                       ///< for render_all()
  Diagnostics warnings;                      ///< when there is a scene: what its author may want to know
  std::vector<std::filesystem::path> files;  ///< all that were read, the scene first; for --deps and watch
};

/// Limits, in all: 256 MiB of YAML, 1000 files, 10^7 values, 10^7 field nodes after expansion.
/// Errors: every mistake of the text at once, each with place and hint.
Result<SceneDescription> read_scene(const std::filesystem::path&, const ReadOptions&, ReadRecord&);
Result<SceneDescription> read_scene(const std::filesystem::path&, const ReadOptions& = {});

}  // namespace marrow
