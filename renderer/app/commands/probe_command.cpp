// marrow probe: a field at given points, in numbers that can be read back without loss.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "field/blend/curvature.h"
#include "field/number/variables_at.h"
#include "field/skeleton/second_order.h"
#include "renderer/app/command_line/commands.h"
#include "renderer/app/command_line/files.h"
#include "renderer/app/input/point_list.h"
#include "renderer/app/input/scene_input.h"
#include "renderer/app/machine/interrupt.h"
#include "renderer/app/machine/tracing_setup.h"
#include "renderer/app/report/report.h"
#include "renderer/app/text/json_values.h"
#include "renderer/app/text/print.h"

namespace marrow {
namespace {

std::string sample_of_field(const FieldProgram& program, const Vec3d& p) {
  const FieldSample s = evaluate(program, p);
  return fmt::format(R"("point": {}, "value": {}, "gradient": {}, "iso": {}, "inside": {})", json(p), json(s.value),
                     json(s.gradient), json(FieldProgram::iso()), s.value > FieldProgram::iso());
}

std::string sample_of_blend(const PlacedBlend& part, const Vec3d& p) {
  const BlendSample s = evaluate_part(part, p);
  return fmt::format(
      R"(, "sum": {}, "sum_gradient": {}, "si_gradient": {}, "si_norm": {}, "alpha": {}, "corrected": {}, )"
      R"("corrected_gradient": {})",
      json(s.sum), json(s.sum_gradient), json(s.si_gradient), json(s.si_norm), json(s.alpha), json(s.corrected),
      json(s.corrected_gradient));
}

// A Hessian in world coordinates: L^T H L, L the map to the blend's own.
Matrix3 in_world(const PlacedBlend& part, const Matrix3& hessian) {
  Matrix3 columns;
  for (std::size_t k = 0; k < 3; ++k)
    columns.rows[k] = part.local_from_world.transposed(hessian.times(part.local_from_world.columns[k]));
  return columns;  // symmetric, so that its columns are its rows
}

std::string hessian_of_sum(const PlacedBlend& part, const Vec3d& p) {
  const Vec3d local = part.is_in_world() ? p : part.local_from_world.point(p);
  const Matrix3 sum = in_world(part, sum_hessian(part.blend, local));
  return fmt::format(R"(, "sum_hessian": [{}, {}, {}])", json(sum.rows[0]), json(sum.rows[1]), json(sum.rows[2]));
}

std::string curvature_of_field(const FieldProgram& program, const Vec3d& p) {
  const HessianJet f = second_order_value(program, variables_at<HessianJet>(p));
  const Matrix3 hessian = hessian_of(f);
  const Curvature curvature = curvature_of(gradient_of(f), hessian);
  return fmt::format(R"(, "hessian": [{}, {}, {}], "mean_curvature": {}, "gaussian_curvature": {})",
                     json(hessian.rows[0]), json(hessian.rows[1]), json(hessian.rows[2]), json(curvature.mean),
                     json(curvature.gaussian));
}

// What has no material of its own has that of the object.
std::string materials_of_field(const FieldObject& field, const SceneDescription& scene, const Vec3d& p) {
  MaterialWeights weights;
  for (const MaterialWeight& w : material_weights(field.program, p))
    add_weight(weights, w.material.valid() ? w.material : scene.objects[field.object.index()].material, w.weight);
  nlohmann::ordered_json names = nlohmann::ordered_json::object();
  for (const MaterialWeight& w : weights) names[scene.materials[w.material.index()].name] = w.weight;
  return fmt::format(R"(, "materials": {})", names.dump());
}

std::string text_of(const FieldObject& field, const SceneDescription& scene, const Vec3d& p,
                    const ProbeCommand& command) {
  const FieldProgram& program = field.program;
  const bool blend = is_single_blend(program);
  std::string sample = sample_of_field(program, p);
  if (blend) sample += sample_of_blend(program.parts()[0], p);
  if (blend && command.curvature) sample += hessian_of_sum(program.parts()[0], p);
  if (command.curvature) sample += curvature_of_field(program, p);
  if (command.materials) sample += materials_of_field(field, scene, p);
  return fmt::format("{{{}}}", sample);
}

// Returns how many were told, in their order, up to an interrupt.
std::size_t print_samples(const FieldObject& field, const SceneDescription& scene, std::span<const Vec3d> points,
                          const ProbeCommand& command) {
  constexpr std::size_t batch = 1 << 12;  // of texts held in memory
  std::size_t told = 0;
  std::vector<std::string> texts;
  say("[");
  while (told < points.size() && !interruption_flag()) {
    const auto now = points.subspan(told, std::min(batch, points.size() - told));
    texts.assign(now.size(), {});
    tbb::parallel_for(std::size_t{0}, now.size(), [&](std::size_t i) {
      if (!interruption_flag()) texts[i] = text_of(field, scene, now[i], command);
    });
    for (std::size_t i = 0; i < now.size() && !texts[i].empty(); ++i, ++told)
      say(fmt::format("{}{}", told == 0 ? "\n" : ",\n", texts[i]));
  }
  say(points.empty() ? "]\n" : "\n]\n");
  return told;
}

Diagnostic several_fields(const std::vector<const FieldObject*>& fields, const SceneDescription& scene) {
  constexpr std::size_t most = 24;
  std::vector<std::string_view> names;
  for (const FieldObject* field : fields)
    if (names.size() < most) names.push_back(scene.objects[field->object.index()].name);
  return with_hint(failure("the scene has several fields; choose one by --object"),
                   fmt::format("there are {}{}", fmt::join(names, ", "), fields.size() > most ? ", …" : ""));
}

Result<std::vector<Vec3d>> points_of(const std::filesystem::path& path, SourceCache& sources) {
  if (path == "-") return read_points(std::cin, "<stdin>", sources);
  std::ifstream file(path);
  return read_points(file, path.string(), sources);
}

}  // namespace

ExitCode run(const ProbeCommand& command) {
  ReadRecord record;
  const auto scene = load_and_report(command.scene, record);
  if (!scene) return exit_code_of_failed_load(command.scene);
  const auto fields = select_fields(*scene, command.object);
  if (!fields) return report(fields.why(), ExitCode::Usage);
  if (fields->size() > 1) return report({several_fields(*fields, scene->description)}, ExitCode::Usage);

  if (command.points != "-") {
    if (const auto status = check_readable(command.points); !status) return report(status.why(), ExitCode::NoInput);
  }
  SourceCache sources;
  const auto points = points_of(command.points, sources);
  if (!points) return report(points.why(), sources, ExitCode::BadInput);
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, most_threads(command.threads));
  interruption_flag();  // from here on signals end the list, not the program
  const std::size_t told = print_samples(*fields->front(), scene->description, *points, command);
  if (told == points->size()) return ExitCode::Ok;
  complain(fmt::format("interrupted; {} of {} points were evaluated\n", told, points->size()));
  return ExitCode::Interrupted;
}

}  // namespace marrow
