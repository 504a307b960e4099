// Whole processes in turns.
#include "renderer/bench/process_race.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "renderer/bench/child_process.h"
#include "renderer/bench/povray_scene.h"

namespace marrow {
namespace {

using Path = std::filesystem::path;

// A program at work with a number of samples; one result a round.
struct Contestant {
  std::string name;
  int samples;
  Path program;
  std::vector<std::string> arguments;
  std::vector<std::optional<ChildResult>> runs;

  bool ended_well() const {
    return std::ranges::all_of(runs, [](const auto& run) { return run.has_value(); });
  }
  Costs costs() const {
    std::vector<Cost> rounds;
    for (const auto& run : runs) rounds.push_back(run->cost);
    return whole_costs(std::move(rounds));
  }
  std::size_t peak() const {
    std::size_t most = 0;
    for (const auto& run : runs) most = std::max(most, run->peak_bytes);
    return most;
  }
};

Contestant marrow_with(const BenchSettings& settings, const Path& scene, int samples) {
  return {"marrow",
          samples,
          this_program(),
          {"render", scene.string(), "-o", Path(scene).replace_extension(".exr").string(), "--spp",
           std::to_string(samples), "-t", std::to_string(settings.threads), "--quiet"},
          {}};
}

// More than one sample is a regular grid for every pixel: at a threshold of 0 each differs enough from its neighbours.
Contestant povray_with(const BenchSettings& settings, const Path& program, const Path& blob, int samples) {
  std::vector<std::string> words{"+I" + blob.string(),
                                 "+O" + Path(blob).replace_extension(".png").string(),
                                 fmt::format("+W{}", settings.size),
                                 fmt::format("+H{}", settings.size),
                                 fmt::format("+WT{}", settings.threads),
                                 "-D",
                                 "+FN8"};
  if (samples == 1) {
    words.emplace_back("-A");
    return {"povray blob", 1, program, words, {}};
  }
  const int grid = povray_grid(samples);
  words.insert(words.end(), {"+A0.0", "+AM1", fmt::format("+R{}", grid)});
  return {"povray blob", samples_of_povray_grid(grid), program, words, {}};
}

void run_in_turns(std::vector<Contestant>& all, int rounds, const StopRequest& stop,
                  const std::function<void(int round)>& tell) {
  for (int round = 0; round < rounds; ++round) {
    tell(round + 1);
    for (Contestant& c : all) {
      if (stop.is_made()) return;
      c.runs.push_back(run_program(c.program, c.arguments, stop));
    }
  }
}

void add(const Contestant& c, const std::vector<Contestant>& all, WorkloadFigures& out) {
  if (!c.ended_well()) {
    out.missing.push_back(fmt::format("{} with {} spp: did not end well", c.name, c.samples));
    return;
  }
  const Costs costs = c.costs();
  ProcessFigures figures{c.name, c.samples, median(costs.rounds), c.peak(), {}};
  const auto own = std::ranges::find_if(
      all, [&](const Contestant& o) { return o.name == "marrow" && o.samples == c.samples && o.ended_well(); });
  if (own != all.end()) figures.ratio = median_ratio(costs, own->costs());
  out.processes.push_back(std::move(figures));
}

}  // namespace

int povray_grid(int samples) {
  int best = 1;
  for (int k = 2; k <= 9; ++k)
    if (std::abs(samples_of_povray_grid(k) - samples) < std::abs(samples_of_povray_grid(best) - samples)) best = k;
  return best;
}

void race_processes(const Workload& workload, const BenchSettings& settings, const Path& scene,
                    const std::function<void(const std::string&)>& tell, WorkloadFigures& out) {
  const auto povray = find_program("povray");
  const auto blob = Path(scene).replace_extension(".pov");
  const bool with_povray = povray && settings.povray && write_povray_blob(workload, blob);
  if (!povray && settings.povray) out.missing.push_back("POV-Ray: not installed");
  for (const int samples : {1, settings.samples}) {
    if (samples > 1 && !settings.many_samples) continue;
    const int rounds = samples > 1 ? 1 : settings.rounds;
    std::vector<Contestant> all{marrow_with(settings, scene, samples)};
    if (with_povray) {
      const Contestant theirs = povray_with(settings, *povray, blob, samples);
      if (theirs.samples != samples) all.push_back(marrow_with(settings, scene, theirs.samples));
      all.push_back(theirs);
    }
    run_in_turns(all, rounds, settings.stop, [&](int round) {
      tell(fmt::format("{}: whole processes, {} spp, round {} of {}", workload.name, samples, round, rounds));
    });
    if (settings.stop.is_made()) return;
    for (const Contestant& c : all) add(c, all, out);
  }
}

}  // namespace marrow
