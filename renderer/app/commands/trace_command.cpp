// marrow trace: rays of a list, each with what it meets, in numbers that can be read back without loss.
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "renderer/app/command_line/commands.h"
#include "renderer/app/command_line/files.h"
#include "renderer/app/input/ray_list.h"
#include "renderer/app/input/scene_input.h"
#include "renderer/app/machine/interrupt.h"
#include "renderer/app/machine/tracing_setup.h"
#include "renderer/app/report/report.h"
#include "renderer/app/text/json_values.h"
#include "renderer/app/text/print.h"
#include "renderer/geometry/build_surfaces.h"
#include "renderer/transport/render.h"

namespace marrow {
namespace {

// What is known of a ray when it has been traced.
struct Answer {
  std::optional<SurfaceHit> hit;
  RayRecord record;
  std::uint8_t is_occluded = 0;
  bool is_known = false;  // not where an interrupt came first
};

// Of the rays that go together. Beside blends rays through the same cells gain by company; trees take rays one by one,
// some of them seconds, and an interrupt is looked at between groups.
std::size_t group_of(const Surfaces& surfaces) { return surfaces.traces_packets() ? 1024 : 1; }

void trace(const Surfaces& surfaces, std::span<const ListedRay> listed, bool occlusion, std::span<Answer> answers) {
  std::vector<Ray> rays;
  for (const ListedRay& ray : listed) rays.push_back(ray.ray());
  if (occlusion) {
    std::vector<std::uint8_t> hidden(rays.size());
    surfaces.occluded(rays, hidden);
    for (std::size_t i = 0; i < rays.size(); ++i) answers[i] = {{}, {}, hidden[i], true};
    return;
  }
  std::vector<std::optional<SurfaceHit>> hits(rays.size());
  std::vector<RayRecord> records(rays.size());
  surfaces.first_hits(rays, hits, records);
  for (std::size_t i = 0; i < rays.size(); ++i) answers[i] = {hits[i], records[i], 0, true};
}

void trace_all(const Surfaces& surfaces, std::span<const ListedRay> rays, bool occlusion, std::span<Answer> answers) {
  const auto trace_group = [&](const tbb::blocked_range<std::size_t>& group) {
    if (interruption_flag()) return;
    trace(surfaces, rays.subspan(group.begin(), group.size()), occlusion, answers.subspan(group.begin(), group.size()));
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), group_of(surfaces)), trace_group,
                    tbb::simple_partitioner{});
}

std::string text_of(const SurfaceHit& hit, const ListedRay& ray, const SceneDescription& scene) {
  return fmt::format(R"(, "t": {}, "position": {}, "normal": {}, "outside": {}, "object": {}, "material": {})",
                     json(ray.t_of(hit.t)), json(hit.position), json(hit.normal.vec()), json(hit.outside),
                     json(scene.objects[hit.object.index()].name), json(scene.materials[hit.material.index()].name));
}

std::string text_of(const Answer& answer, const ListedRay& ray, const SceneDescription& scene, bool occlusion) {
  std::string text = fmt::format(R"({{"origin": {}, "direction": {}, )", json(ray.origin), json(ray.direction));
  if (occlusion) return text + fmt::format(R"("occluded": {}}})", answer.is_occluded != 0);
  text += fmt::format(R"("hit": {})", answer.hit.has_value());
  if (answer.hit) text += text_of(*answer.hit, ray, scene);
  return text +
         fmt::format(R"(, "evaluations": {}, "certified": {}}})", answer.record.evaluations, answer.record.certified);
}

struct Outcome {
  std::size_t traced = 0, uncertified = 0;  // of all that are asked for, up to an interrupt
};

Outcome trace_and_print(const Surfaces& surfaces, std::span<const ListedRay> rays, const SceneDescription& scene,
                        bool occlusion) {
  constexpr std::size_t batch = 1 << 16;  // of answers held in memory
  Outcome outcome;
  std::vector<Answer> answers;
  say("[");
  while (outcome.traced < rays.size() && !interruption_flag()) {
    const auto now = rays.subspan(outcome.traced, std::min(batch, rays.size() - outcome.traced));
    answers.assign(now.size(), {});
    trace_all(surfaces, now, occlusion, answers);
    for (std::size_t i = 0; i < now.size() && answers[i].is_known; ++i, ++outcome.traced) {
      say(outcome.traced == 0 ? "\n" : ",\n");
      say(text_of(answers[i], now[i], scene, occlusion));
      if (!answers[i].record.certified) ++outcome.uncertified;
    }
  }
  say("\n]\n");
  return outcome;
}

Result<std::vector<ListedRay>> rays_of(const std::filesystem::path& path, SourceCache& sources) {
  if (path == "-") return read_rays(std::cin, "<stdin>", sources);
  std::ifstream file(path);
  return read_rays(file, path.string(), sources);
}

Diagnostics doubts_about(const Outcome& outcome) {
  if (outcome.uncertified == 0) return {};
  const std::string rays = outcome.uncertified == 1 ? "1 ray" : fmt::format("{} rays", outcome.uncertified);
  Diagnostic doubt =
      failure(fmt::format("of {} it is not proved that no surface was missed (`certified` is false there)", rays));
  doubt.severity = Severity::Warning;
  return {doubt};
}

ExitCode tell(const Outcome& outcome, std::size_t asked, bool strict) {
  if (outcome.traced < asked) {
    complain(fmt::format("interrupted; {} of {} rays were traced\n", outcome.traced, asked));
    return ExitCode::Interrupted;
  }
  const auto doubts = doubts_about(outcome);
  return report(doubts, strict && !doubts.empty() ? ExitCode::Doubtful : ExitCode::Ok);
}

}  // namespace

ExitCode run(const TraceCommand& command) {
  if (const auto missing = missing_instruction_set({command.isa}); !missing.empty())
    return report(missing, ExitCode::Unavailable);
  ReadRecord record;
  const auto scene = read_and_report(command.scene, record);
  if (!scene) return exit_code_of_failed_load(command.scene);
  if (command.rays != "-") {
    if (const auto status = check_readable(command.rays); !status) return report(status.why(), ExitCode::NoInput);
  }
  SourceCache sources;
  const auto rays = rays_of(command.rays, sources);
  if (!rays) return report(rays.why(), sources, ExitCode::BadInput);

  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, most_threads(command.threads));
  const auto surfaces =
      build_surfaces(*scene, {.isa = command.isa, .threads = command.threads, .samples = sample_count(scene->render)});
  if (!surfaces) return report(surfaces.why(), record.sources, exit_code_of_failed_build(surfaces.why()));
  interruption_flag();  // from here on signals end the list, not the program
  return tell(trace_and_print(**surfaces, *rays, *scene, command.occluded), rays->size(), command.strict);
}

}  // namespace marrow
