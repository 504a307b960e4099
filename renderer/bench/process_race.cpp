// Whole processes in turns.
#include "renderer/bench/process_race.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "renderer/bench/child_process.h"
#include "renderer/bench/povray_scene.h"

namespace marrow {
namespace {

using Path = std::filesystem::path;
using Runs = std::vector<std::optional<ChildResult>>;

std::vector<std::string> marrow_arguments(const BenchSettings& settings, const Path& scene, int samples) {
  return {"render", scene.string(),          "-o", Path(scene).replace_extension(".exr").string(),
          "--spp",  std::to_string(samples), "-t", std::to_string(settings.threads),
          "--quiet"};
}

// More than one sample is a regular grid of four by four for every pixel.
std::vector<std::string> povray_arguments(const BenchSettings& settings, const Path& blob, int samples) {
  std::vector<std::string> words{"+I" + blob.string(),
                                 "+O" + Path(blob).replace_extension(".png").string(),
                                 fmt::format("+W{}", settings.size),
                                 fmt::format("+H{}", settings.size),
                                 fmt::format("+WT{}", settings.threads),
                                 "-D",
                                 "+FN8"};
  if (samples == 1) words.emplace_back("-A");
  else words.insert(words.end(), {"+A0.0", "+AM1", "+R4"});
  return words;
}

void add(WorkloadFigures& out, const std::string& name, int samples, const Runs& runs, const Runs& of_marrow) {
  std::vector<Cost> costs, ours;
  std::size_t peak = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!runs[i] || !of_marrow[i]) {
      out.missing.push_back(fmt::format("{} with {} spp: did not end well", name, samples));
      return;
    }
    costs.push_back(runs[i]->cost);
    ours.push_back(of_marrow[i]->cost);
    peak = std::max(peak, runs[i]->peak_bytes);
  }
  out.processes.push_back({name, samples, median(costs), peak, median_ratio(costs, ours)});
}

}  // namespace

void race_processes(const Workload& workload, const BenchSettings& settings, const Path& scene,
                    const std::function<void(const std::string&)>& tell, WorkloadFigures& out) {
  const auto povray = find_program("povray");
  const auto blob = Path(scene).replace_extension(".pov");
  const bool with_povray = povray && settings.povray && write_povray_blob(workload, blob);
  if (!povray && settings.povray) out.missing.push_back("POV-Ray: not installed");
  for (const int samples : {1, settings.samples}) {
    if (samples > 1 && !settings.many_samples) continue;
    const int rounds = samples > 1 ? 1 : settings.rounds;
    Runs ours, theirs;
    for (int round = 0; round < rounds; ++round) {
      tell(fmt::format("{}: whole processes, {} spp, round {} of {}", workload.name, samples, round + 1, rounds));
      ours.push_back(run_program(this_program(), marrow_arguments(settings, scene, samples)));
      if (with_povray) theirs.push_back(run_program(*povray, povray_arguments(settings, blob, samples)));
    }
    add(out, "marrow", samples, ours, ours);
    if (with_povray) add(out, "povray blob", samples, theirs, ours);
  }
}

}  // namespace marrow
