// marrow bench: the program and its peers on common scenes.
#include <cstdio>
#include <system_error>

#include "renderer/app/bench_report.h"
#include "renderer/app/commands.h"
#include "renderer/app/print.h"
#include "renderer/app/report.h"
#include "renderer/bench/workload.h"

namespace marrow {
namespace {

ExitCode write_scenes(const BenchCommand& command) {
  std::error_code error;
  std::filesystem::create_directories(*command.write_to, error);
  for (const auto& name : command.settings.workloads.empty() ? workload_names() : command.settings.workloads) {
    const auto workload = workload_named(name);
    if (!workload) return report(workload.why(), ExitCode::Usage);
    const auto status = write_scene(*workload, command.settings.size, *command.write_to / (name + ".yaml"));
    if (!status) return report(status.why(), ExitCode::CannotCreate);
  }
  for (std::size_t count = 1000; count <= command.settings.largest_scaling; count *= 10) {
    for (const Workload& w : {strands(count), tufts(count)})
      if (auto status = write_scene(w, command.settings.size, *command.write_to / (w.name + ".yaml")); !status)
        return report(status.why(), ExitCode::CannotCreate);
  }
  return ExitCode::Ok;
}

}  // namespace

ExitCode run(const BenchCommand& command) {
  if (command.write_to) return write_scenes(command);
  if (!command.json) say(bench_text(command.settings));
  const auto figures = run_benchmark(
      command.settings, [](const std::string& what) { complain(what + '\n'); },
      [&](const WorkloadFigures& w) {
        if (command.json) return;
        say(bench_text(w));
        std::fflush(stdout);
      });
  if (!figures) return report(figures.why(), ExitCode::Internal);
  if (command.json) say(bench_json(command.settings, *figures));
  return ExitCode::Ok;
}

}  // namespace marrow
