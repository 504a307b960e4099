// marrow check: every mistake of a scene, without rendering it.
#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "field/trace/blend_tracer.h"
#include "field/tree/field_tree.h"
#include "renderer/app/command_line/commands.h"
#include "renderer/app/input/environment.h"
#include "renderer/app/input/scene_input.h"
#include "renderer/app/picture/picture_advice.h"
#include "renderer/app/report/report.h"
#include "renderer/app/text/print.h"
#include "renderer/app/text/text.h"
#include "renderer/geometry/build_surfaces.h"

namespace marrow {
namespace {

bool may_have_no_surface(const FieldProgram& field) {
  return std::ranges::any_of(
             field.parts(),
             [](const PlacedBlend& part) { return !part.blend.cavity && !BlendTracer::refusal(part.blend).empty(); }) ||
         std::ranges::any_of(field.trees(), [](const FieldTree& tree) {
           const Box3 box = surface_bounds(tree);
           return !box.empty() && !is_finite(box.size());
         });
}

// What rays cannot meet. Building it tells; that of a large scene takes memory, so only what is in doubt is built.
Diagnostics check_surfaces(const LoadedScene& scene) {
  SceneDescription doubtful;
  for (const FieldObject& field : scene.fields)
    if (may_have_no_surface(field.program)) doubtful.objects.push_back(scene.description.objects[field.object.index()]);
  if (doubtful.objects.empty()) return {};
  const auto surfaces = build_surfaces(doubtful, {});
  return surfaces ? Diagnostics{} : surfaces.why();
}

std::string summary(const LoadedScene& scene) {
  std::size_t primitives = 0;
  for (const auto& field : scene.fields) primitives += primitive_count(field.program);
  const auto& d = scene.description;
  return fmt::format("{} ({} of field primitives: {}), {}, {}", counted(d.objects.size(), "object"),
                     scene.fields.size(), primitives, counted(d.materials.size(), "material"),
                     counted(d.lights.size(), "light"));
}

}  // namespace

ExitCode run(const CheckCommand& command) {
  ReadRecord record;
  const auto scene = load(command.scene, record);
  Diagnostics errors = scene ? check_environments(scene->description) : scene.why();
  if (scene)
    for (Diagnostic& d : check_surfaces(*scene)) errors.push_back(std::move(d));
  // What has no place is the scene file itself; editors want its name.
  if (command.json)
    for (Diagnostic& d : errors)
      if (d.where.file.empty()) d.where.file = command.scene.path.string();
  Diagnostics all = errors;
  all.insert(all.end(), record.warnings.begin(), record.warnings.end());
  if (scene)
    for (Diagnostic& d : picture_advice(scene->description, command.scene)) all.push_back(std::move(d));
  if (command.json) say(to_json(all) + '\n');
  else report(all, record.sources, ExitCode::Ok);
  if (!errors.empty()) return exit_code_of_failed_load(command.scene);
  if (!command.json) say(fmt::format("{}: ok: {}\n", command.scene.path.string(), summary(*scene)));
  return ExitCode::Ok;
}

}  // namespace marrow
