// Metadata, files, warnings and the exit code, in this order.
#include "renderer/app/finish_render.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include <fmt/core.h>

#include "renderer/app/report.h"
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

// Samples of a pixel: what was asked for, and what was reached.
struct SampleCounts {
  int asked = 0;
  std::uint32_t fewest = 0, most = 0;
};

SampleCounts sample_counts(const Picture& picture, int asked) {
  SampleCounts counts{.asked = asked};
  for (const Channel& channel : picture.channels)
    if (const auto* reached = std::get_if<std::vector<std::uint32_t>>(&channel.samples);
        channel.name == "samples" && reached && !reached->empty()) {
      counts.fewest = *std::ranges::min_element(*reached);
      counts.most = *std::ranges::max_element(*reached);
    }
  return counts;
}

Picture picture_of(const Film& film, const SceneDescription& scene, const RenderSettings& settings) {
  Picture picture = to_picture(film);
  const auto clamped = [](std::uint64_t n) { return static_cast<int>(std::min<std::uint64_t>(n, INT32_MAX)); };
  const SampleCounts samples = sample_counts(picture, settings.samples_per_pixel);
  picture.metadata = {
      {"marrow/sceneHash", scene.hash},
      {"marrow/seed", std::to_string(settings.seed)},
      {"marrow/spp", samples.asked},
      {"marrow/sppRange", fmt::format("{}-{}", samples.fewest, samples.most)},
      {"marrow/stop", std::string(name_of(film.stopped_by))},
      {"marrow/invalidSamples", clamped(film.invalid_samples().count)},
      {"marrow/uncertifiedPixels", clamped(film.uncertified_pixels())},
  };
  if (!scene.units.empty()) picture.metadata.push_back({"marrow/units", scene.units});
  // Whoever asks for the same bytes each time (SOURCE_DATE_EPOCH) gets no clock in them.
  if (!std::getenv("SOURCE_DATE_EPOCH")) picture.metadata.push_back({"marrow/renderTime", film.elapsed_s});
  return picture;
}

Diagnostics write(const Picture& picture, const SceneDescription& scene, const Preparation& ready) {
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

Diagnostics doubts_about(const Film& film) {
  Diagnostics doubts;
  const auto warn = [&](std::string text) {
    doubts.push_back({.where = {}, .message = std::move(text), .hint = {}, .severity = Severity::Warning});
  };
  if (const auto invalid = film.invalid_samples(); invalid.count > 0)
    warn(fmt::format("{} samples were not finite or negative and were left out, the first at pixel {}, {}",
                     invalid.count, invalid.x, invalid.y));
  if (const auto pixels = film.uncertified_pixels(); pixels > 0)
    warn(fmt::format("at {} pixels it is not proved that no surface was missed", pixels));
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
  if (const auto problems = write(picture_of(film, scene, settings), scene, ready); !problems.empty()) {
    progress.close("the picture is lost");
    return report(problems, ExitCode::WriteFailed);
  }
  progress.close(closing_line(film, ready.outputs));
  if (film.stopped_by == StopReason::Interrupted) return ExitCode::Interrupted;
  const auto doubts = doubts_about(film);
  return report(doubts, strict && !doubts.empty() ? ExitCode::Doubtful : ExitCode::Ok);
}

}  // namespace marrow
