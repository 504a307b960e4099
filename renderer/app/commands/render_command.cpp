// marrow render: scene text -> description -> surfaces and light -> film -> files.
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include <tbb/global_control.h>
#include <tbb/parallel_invoke.h>

#include "renderer/app/command_line/commands.h"
#include "renderer/app/command_line/files.h"
#include "renderer/app/input/environment.h"
#include "renderer/app/input/scene_input.h"
#include "renderer/app/machine/interrupt.h"
#include "renderer/app/machine/tracing_setup.h"
#include "renderer/app/picture/finish_render.h"
#include "renderer/app/picture/picture_advice.h"
#include "renderer/app/picture/picture_outputs.h"
#include "renderer/app/report/progress_line.h"
#include "renderer/app/report/report.h"
#include "renderer/geometry/build_surfaces.h"
#include "renderer/transport/render.h"
#include "renderer/transport/render_scene.h"

namespace marrow {
namespace {

struct Stop {
  Diagnostics why;
  ExitCode code;
};

std::variant<Preparation, Stop> prepare(const RenderCommand& command, const SceneDescription& scene,
                                        const ReadRecord& record) {
  Preparation ready;
  auto outputs = choose_outputs(command);
  if (!outputs) return Stop{outputs.why(), ExitCode::Usage};
  ready.outputs = *outputs;
  if (auto problems = unwritable(ready.outputs, files_of(scene, record)); !problems.empty())
    return Stop{problems, ExitCode::CannotCreate};
  if (command.ocio) {
    if (auto status = check_readable(*command.ocio); !status) return Stop{status.why(), ExitCode::NoInput};
  }
  if (ready.outputs.png || !command.view.empty()) {
    auto display = Display::open(command.ocio, {}, command.view);
    if (!display) return Stop{display.why(), ExitCode::Usage};
    if (ready.outputs.png) ready.display = std::move(*display);
  }
  if (command.crop) {
    auto window = resolve(*command.crop, scene.film.width, scene.film.height);
    if (!window) return Stop{window.why(), ExitCode::Usage};
    ready.crop = *window;
  }
  return ready;
}

RenderSettings settings_over(const RenderCommand& command, RenderSettings settings) {
  if (command.samples_per_pixel) settings.samples_per_pixel = *command.samples_per_pixel;
  if (command.seed) settings.seed = *command.seed;
  return settings;
}

SurfaceOptions surface_options(const RenderCommand& command, const RenderSettings& settings) {
  return {.isa = command.isa,
          .embree_isa = command.embree_isa,
          .threads = command.threads,
          .eager = command.eager,
          .samples = sample_count(settings)};
}

}  // namespace

ExitCode run(const RenderCommand& command) {
  if (const auto missing = missing_instruction_set({command.isa, command.embree_isa}); !missing.empty())
    return report(missing, ExitCode::Unavailable);
  ReadRecord record;
  const auto scene = read_and_report(command.scene, record);
  if (!scene) return exit_code_of_failed_load(command.scene);
  report(picture_advice(*scene, command.scene), record.sources, ExitCode::Ok);
  const auto prepared = prepare(command, *scene, record);
  if (const auto* stop = std::get_if<Stop>(&prepared)) return report(stop->why, stop->code);
  const auto& ready = std::get<Preparation>(prepared);

  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, most_threads(command.threads));
  ProgressLine progress(command.progress);
  progress.phase("building");
  const RenderSettings settings = settings_over(command, scene->render);
  Result<std::unique_ptr<Surfaces>> surfaces = Diagnostics{};
  std::optional<Film> empty;  // the memory of films takes as long to get as small surfaces to build, on one thread
  tbb::parallel_invoke([&] { empty = empty_film(scene->film.width, scene->film.height, ready.crop); },
                       [&] { surfaces = build_surfaces(*scene, surface_options(command, settings)); });
  progress.clear();
  if (!surfaces) return report(surfaces.why(), record.sources, exit_code_of_failed_build(surfaces.why()));
  const auto compiled = compile_transport(*scene, **surfaces, load_environment);
  if (!compiled) return report(compiled.why(), record.sources, ExitCode::BadInput);

  const Film film = render(*compiled, settings,
                           {.crop = ready.crop,
                            .threads = command.threads,
                            .tile_size = command.tile_size,
                            .time_limit_s = command.time_limit_s,
                            .progress = [&](const Progress& p) { progress.show(p); },
                            .interrupted = &interruption_flag()},
                           std::move(*empty));
  ExitCode code = ExitCode::Ok;
  tbb::parallel_invoke([&] { surfaces->reset(); },  // not needed any more, and long to give back
                       [&] { code = finish(film, *scene, settings, ready, command.strict, progress); });
  return code;
}

}  // namespace marrow
