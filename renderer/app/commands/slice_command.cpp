// marrow slice: a field on an axis plane, in false colour or as raw numbers.
#include <algorithm>

#include <fmt/core.h>

#include "field/program/programs_in_box.h"
#include "renderer/app/command_line/commands.h"
#include "renderer/app/command_line/files.h"
#include "renderer/app/input/scene_input.h"
#include "renderer/app/machine/interrupt.h"
#include "renderer/app/report/report.h"
#include "renderer/app/text/print.h"
#include "renderer/output/exr.h"
#include "renderer/output/image_file.h"
#include "renderer/slice/slice.h"

namespace marrow {
namespace {

SliceSample sample_of(const FieldSample& s) { return {s.value, s.gradient}; }

SliceField in_box(const ProgramsInBox& programs) {
  return {.at = [programs](const Vec3d& p) { return sample_of(programs.at(p)); },
          .within = [programs](const Box3& box) { return in_box(programs.within(box)); }};
}

// Of several objects the largest value: what is inside any of them is inside. Few skeletons are all summed as they are.
SliceField largest_of(const std::vector<const FieldObject*>& fields) {
  constexpr std::size_t few = 64;
  std::vector<const FieldProgram*> programs;
  std::size_t count = 0;
  for (const FieldObject* field : fields) {
    programs.push_back(&field->program);
    count += count_of_all(field->program);
  }
  SliceField largest = in_box(ProgramsInBox(programs));
  if (count <= few) largest.within = nullptr;
  return largest;
}

Box3 extent_of(const std::vector<const FieldObject*>& fields) {
  Box3 box;
  for (const auto* field : fields) box.include(extent(field->program));
  return box;
}

Status write(const SliceImage& image, const SliceCommand& command, const SceneDescription& scene) {
  if (command.output.extension() == ".exr") {
    Picture picture = to_exr_picture(image);
    picture.metadata.push_back({"marrow/sceneHash", scene.hash});
    return write_exr(command.output, picture);
  }
  SliceStyle style;
  style.range = command.request.range;
  style.colormap = command.request.colormap;
  style.units = scene.units;
  const auto painted = paint(image, style);
  if (!painted) return painted.why();
  return write_png(command.output, *painted, PngDepth::Bits8, {{"marrow/sceneHash", scene.hash}});
}

// A picture without a line says too little: on which side of the surface all of it is, and how far from it.
Diagnostics doubts_about(const SliceImage& image) {
  const auto [least, most] = std::ranges::minmax(image.samples, {}, &SliceSample::value);
  if (least.value <= image.iso && image.iso <= most.value) return {};
  const bool outside = most.value < image.iso;
  Diagnostic doubt = failure(fmt::format(
      "the surface, where the field is {}, does not meet this window: {} {:.3g}", image.iso,
      outside ? "there the field is at most" : "there the field is at least", outside ? most.value : least.value));
  doubt.hint = "`info` tells where the objects are";
  doubt.severity = Severity::Warning;
  return {doubt};
}

}  // namespace

ExitCode run(const SliceCommand& command) {
  const auto ending = command.output.extension();
  if (ending != ".exr" && ending != ".png")
    return report({failure("the output must be a name with the ending .exr or .png", command.output.string())},
                  ExitCode::Usage);
  ReadRecord record;
  const auto scene = load_and_report(command.scene, record);
  if (!scene) return exit_code_of_failed_load(command.scene);
  const auto fields = select_fields(*scene, command.object);
  if (!fields) return report(fields.why(), ExitCode::Usage);
  auto status = check_apart(command.output, files_of(scene->description, record));
  if (status) status = check_writable(command.output);
  if (!status) return report(status.why(), ExitCode::CannotCreate);

  SliceRequest request = command.request;
  request.interrupted = &interruption_flag();
  const auto image = slice(largest_of(*fields), FieldProgram::iso(), extent_of(*fields), request);
  if (!image) return report(image.why(), ExitCode::Usage);
  if (interruption_flag()) return complain("interrupted; nothing was written\n"), ExitCode::Interrupted;
  const auto written = write(*image, command, scene->description);
  if (!written) return report(written.why(), ExitCode::WriteFailed);
  return report(doubts_about(*image), ExitCode::Ok);
}

}  // namespace marrow
