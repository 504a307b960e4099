// The scene of a command line: read, checked as far as it can be without rendering, and its fields made ready.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "field/math/box3.h"
#include "field/program/field_program.h"
#include "renderer/app/command_line/commands.h"
#include "renderer/scene/read_scene.h"

namespace marrow {

/// One of a scene's objects that are fields.
struct FieldObject {
  ObjectId object;
  FieldProgram program;
};

struct LoadedScene {
  SceneDescription description;
  std::vector<FieldObject> fields;
};

/// Reads the scene and compiles its fields; `record` tells of texts and warnings (also those of the fields).
Result<LoadedScene> load(const SceneInput&, ReadRecord& record);

/// How most commands begin: load(), or read_scene() alone, and mistakes or else warnings are reported.
std::optional<LoadedScene> load_and_report(const SceneInput&, ReadRecord& record);
std::optional<SceneDescription> read_and_report(const SceneInput&, ReadRecord& record);

/// All files that the scene was or will be made from: those that were read, and the images of its lights.
std::vector<std::filesystem::path> files_of(const SceneDescription&, const ReadRecord&);

/// NoInput when the scene's file is not there or cannot be read, else BadInput: how a command whose load() failed ends.
ExitCode exit_code_of_failed_load(const SceneInput&);

/// The fields a command speaks of: the one named, or all of them when no name is given.
/// Errors: no such object, an object that is not a field, a scene without fields; the names there are stand in the
/// hint.
Result<std::vector<const FieldObject*>> select_fields(const LoadedScene&, const std::optional<std::string>& name);

/// The skeletons in world coordinates, and the largest radius around them: holds what a picture of the field should
/// show, though a blend of many may swell beyond it.
Box3 extent(const FieldProgram&);

std::size_t primitive_count(const FieldProgram&);

}  // namespace marrow
