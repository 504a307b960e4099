// marrow check: every mistake of a scene, without rendering it.
#include <cstdio>
#include <utility>

#include <fmt/core.h>

#include "renderer/app/command_line/commands.h"
#include "renderer/app/input/environment.h"
#include "renderer/app/input/scene_input.h"
#include "renderer/app/picture/picture_advice.h"
#include "renderer/app/report/report.h"
#include "renderer/app/text/print.h"

namespace marrow {
namespace {

std::string counted(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
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
