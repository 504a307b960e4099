// Metadata, files, warnings and the exit code, in this order.
#include "renderer/app/picture/finish_render.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include <fmt/core.h>

#include "renderer/app/report/report.h"
#include "renderer/output/exr.h"
#include "renderer/output/image_file.h"

namespace marrow {
namespace {

const char* name_of(StopReason reason) {
  switch (reason) {
    case StopReason::Samples:
      return "spp";
    case StopReason::Time:
      return "time";
    case StopReason::Interrupted:
      return "interrupted";
  }
  return "unknown";
}

PictureRows picture_of(const Film& film, const FilmSummary& summary, const SceneDescription& scene,
                       const RenderSettings& settings) {
  PictureRows picture = to_rows(film);
  const auto clamped = [](std::uint64_t n) { return static_cast<int>(std::min<std::uint64_t>(n, INT32_MAX)); };
  picture.metadata = {
      {"marrow/sceneHash", scene.hash},
      {"marrow/seed", std::to_string(settings.seed)},
      {"marrow/spp", settings.samples_per_pixel},
      {"marrow/sppRange", fmt::format("{}-{}", summary.fewest_samples, summary.most_samples)},
      {"marrow/stop", std::string(name_of(film.stopped_by))},
      {"marrow/invalidSamples", clamped(summary.invalid.count)},
      {"marrow/uncertifiedPixels", clamped(summary.uncertified_pixels)},
  };
  if (!scene.units.empty()) picture.metadata.push_back({"marrow/units", scene.units});
  // Whoever asks for the same bytes each time (SOURCE_DATE_EPOCH) gets no clock in them.
  if (!std::getenv("SOURCE_DATE_EPOCH")) picture.metadata.push_back({"marrow/renderTime", film.elapsed_s});
  return picture;
}

Diagnostics write(const PictureRows& picture, const SceneDescription& scene, const Preparation& ready) {
  Diagnostics problems;
  const auto keep = [&](const Diagnostics& why) { problems.insert(problems.end(), why.begin(), why.end()); };
  if (ready.outputs.exr) {
    if (const auto status = write_exr(*ready.outputs.exr, picture); !status) keep(status.why());
  }
  if (ready.outputs.png) {
    const auto image = ready.display->apply(picture);
    if (!image) return keep(image.why()), problems;
    const auto status = write_png(*ready.outputs.png, *image, PngDepth::Bits8,
                                  {{"marrow/sceneHash", scene.hash}, {"marrow/view", ready.display->name()}});
    if (!status) keep(status.why());
  }
  return problems;
}

Diagnostics doubts_about(const FilmSummary& film) {
  Diagnostics doubts;
  const auto warn = [&](std::string text) {
    doubts.push_back({.where = {}, .message = std::move(text), .hint = {}, .severity = Severity::Warning});
  };
  if (film.invalid.count > 0)
    warn(fmt::format("{} samples were not finite or negative and were left out, the first at pixel {}, {}",
                     film.invalid.count, film.invalid.x, film.invalid.y));
  if (film.uncertified_pixels > 0)
    warn(fmt::format("at {} it is not proved that no surface was missed (`field.certified` is 0 there)",
                     film.uncertified_pixels == 1 ? "1 pixel" : fmt::format("{} pixels", film.uncertified_pixels)));
  return doubts;
}

std::string closing_line(const Film& film, const PictureOutputs& outputs) {
  std::string names;
  for (const auto& path : {outputs.exr, outputs.png})
    if (path) names += (names.empty() ? "" : " and ") + path->string();
  return fmt::format("{}{} in {}", film.stopped_by == StopReason::Interrupted ? "interrupted; wrote " : "wrote ", names,
                     clock_text(film.elapsed_s));
}

}  // namespace

ExitCode finish(const Film& film, const SceneDescription& scene, const RenderSettings& settings,
                const Preparation& ready, bool strict, ProgressLine& progress) {
  const FilmSummary summary = film.summary();
  if (const auto problems = write(picture_of(film, summary, scene, settings), scene, ready); !problems.empty()) {
    progress.close("the picture is lost");
    return report(problems, ExitCode::WriteFailed);
  }
  progress.close(closing_line(film, ready.outputs));
  if (film.stopped_by == StopReason::Interrupted) return ExitCode::Interrupted;
  const auto doubts = doubts_about(summary);
  return report(doubts, strict && !doubts.empty() ? ExitCode::Doubtful : ExitCode::Ok);
}

}  // namespace marrow
