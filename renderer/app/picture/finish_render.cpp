// Metadata, files, warnings and the exit code, in this order.
#include "renderer/app/picture/finish_render.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
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

Status write_display(const std::filesystem::path& png, const PictureRows& picture, const SceneDescription& scene,
                     const Preparation& ready) {
  const auto image = ready.display->apply(picture);
  if (!image) return image.why();
  return write_png(png, *image, PngDepth::Bits8,
                   {{"marrow/sceneHash", scene.hash}, {"marrow/view", ready.display->name()}});
}

struct Written {
  PictureOutputs outputs;  // those that are there now
  Diagnostics problems;
};

Written write(const PictureRows& picture, const SceneDescription& scene, const Preparation& ready) {
  Written written{.outputs = ready.outputs, .problems = {}};
  const auto keep = [&](std::optional<std::filesystem::path>& output, const Status& status) {
    if (status) return;
    output.reset();
    written.problems.insert(written.problems.end(), status.why().begin(), status.why().end());
  };
  if (ready.outputs.exr) keep(written.outputs.exr, write_exr(*ready.outputs.exr, picture));
  if (ready.outputs.png) keep(written.outputs.png, write_display(*ready.outputs.png, picture, scene, ready));
  return written;
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
  if (!outputs.exr && !outputs.png) return "the picture is lost";
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
  const Written written = write(picture_of(film, summary, scene, settings), scene, ready);
  progress.close(closing_line(film, written.outputs));
  if (!written.problems.empty()) return report(written.problems, ExitCode::WriteFailed);
  if (film.stopped_by == StopReason::Interrupted) return ExitCode::Interrupted;
  const auto doubts = doubts_about(summary);
  return report(doubts, strict && !doubts.empty() ? ExitCode::Doubtful : ExitCode::Ok);
}

}  // namespace marrow
