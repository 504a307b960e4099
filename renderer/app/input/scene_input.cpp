// Reading and compiling what a command works on.
#include "renderer/app/input/scene_input.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <unistd.h>

#include "renderer/app/report/report.h"
#include "renderer/scene/suggestion.h"

namespace marrow {
namespace {

Diagnostic no_such_field(const LoadedScene& scene, const std::string& name) {
  std::vector<std::string> fields;
  for (const auto& field : scene.fields) fields.push_back(scene.description.objects[field.object.index()].name);
  const auto& objects = scene.description.objects;
  const bool exists = std::any_of(objects.begin(), objects.end(), [&](const auto& o) { return o.name == name; });
  return with_hint(failure(exists ? fmt::format("the object `{}` is not a field", name)
                                  : fmt::format("the scene has no object `{}`", name)),
                   suggest(name, fields));
}

Result<SceneDescription> read(const SceneInput& input, ReadRecord& record) {
  return read_scene(input.path, ReadOptions{.overrides = input.overrides}, record);
}

template <class Scene>
std::optional<Scene> reported(Result<Scene> scene, const ReadRecord& record) {
  report(scene ? record.warnings : scene.why(), record.sources, ExitCode::Ok);
  return scene ? std::optional(std::move(*scene)) : std::nullopt;
}

}  // namespace

Result<LoadedScene> load(const SceneInput& input, ReadRecord& record) {
  auto description = read(input, record);
  if (!description) return description.why();
  LoadedScene scene{std::move(*description), {}};
  Diagnostics errors;
  const auto& objects = scene.description.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto* field = std::get_if<FieldDescription>(&objects[i].shape);
    if (!field) continue;
    auto program = compile(*field);
    if (program) {
      record.warnings.insert(record.warnings.end(), program->warnings().begin(), program->warnings().end());
      scene.fields.push_back({ObjectId{i}, std::move(*program)});
    } else {
      errors.insert(errors.end(), program.why().begin(), program.why().end());
    }
  }
  if (!errors.empty()) return errors;
  return scene;
}

std::optional<LoadedScene> load_and_report(const SceneInput& input, ReadRecord& record) {
  return reported(load(input, record), record);
}

std::optional<SceneDescription> read_and_report(const SceneInput& input, ReadRecord& record) {
  return reported(read(input, record), record);
}

std::vector<std::filesystem::path> files_of(const SceneDescription& scene, const ReadRecord& record) {
  std::vector<std::filesystem::path> files = record.files;
  for (const LightDescription& light : scene.lights)
    if (const auto* image = std::get_if<ImageLight>(&light.what)) files.push_back(image->file);
  return files;
}

ExitCode exit_code_of_failed_load(const SceneInput& input) {
  std::error_code error;
  const bool readable = std::filesystem::is_regular_file(input.path, error) && access(input.path.c_str(), R_OK) == 0;
  return readable ? ExitCode::BadInput : ExitCode::NoInput;
}

Result<std::vector<const FieldObject*>> select_fields(const LoadedScene& scene,
                                                      const std::optional<std::string>& name) {
  std::vector<const FieldObject*> chosen;
  for (const auto& field : scene.fields)
    if (!name || scene.description.objects[field.object.index()].name == *name) chosen.push_back(&field);
  if (!chosen.empty()) return chosen;
  if (name) return no_such_field(scene, *name);
  return failure("the scene has no object that is a field");
}

Box3 extent(const FieldProgram& program) {
  Box3 box;
  for (const auto& part : program.parts()) {
    const Box3 skeletons = skeleton_bounds(part.blend);
    if (!skeletons.empty()) box.include(part.world_from_local.box_around(skeletons.padded(largest_radius(part.blend))));
  }
  for (const auto& tree : program.trees()) {
    const Box3 surface = surface_bounds(tree);
    if (!surface.empty() && is_finite(surface.size())) box.include(surface);
  }
  return box;
}

std::size_t primitive_count(const FieldProgram& program) {
  std::size_t count = 0;
  for (const auto& part : program.parts()) count += part.blend.size();
  for (const auto& tree : program.trees()) count += leaf_count(tree);
  return count;
}

}  // namespace marrow
