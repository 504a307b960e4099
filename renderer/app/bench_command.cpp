// marrow bench: the program and its peers on common scenes.
#include <array>
#include <cstdio>
#include <set>
#include <system_error>
#include <utility>

#include "renderer/app/bench_report.h"
#include "renderer/app/commands.h"
#include "renderer/app/print.h"
#include "renderer/app/report.h"
#include "renderer/bench/workload.h"
#include "renderer/bench/workload_reader.h"
#include "renderer/scene/input_files.h"
#include "renderer/scene/source_cache.h"

namespace marrow {
namespace {

struct Chosen {
  std::vector<Workload> workloads;
  SourceCache sources;
  Diagnostics problems;
  ExitCode code = ExitCode::Ok;  // of the first problem

  void add_problems(const Diagnostics& more, ExitCode why) {
    if (code == ExitCode::Ok) code = why;
    problems.insert(problems.end(), more.begin(), more.end());
  }
};

void add_file(const std::string& name, Chosen& chosen) {
  auto file = InputFiles().read(name);
  if (!file) return chosen.add_problems(file.why(), ExitCode::NoInput);
  auto workload = read_workload(file->bytes, name);
  chosen.sources.add(name, std::move(file->bytes));
  if (!workload) return chosen.add_problems(workload.why(), ExitCode::BadInput);
  chosen.workloads.push_back(std::move(*workload));
}

void add_named(const std::string& name, Chosen& chosen) {
  auto workload = workload_named(name);
  if (!workload) return chosen.add_problems(workload.why(), ExitCode::Usage);
  chosen.workloads.push_back(std::move(*workload));
}

// Their names are those of files when they are written.
void ask_for_different_names(Chosen& chosen) {
  std::set<std::string> names;
  for (const Workload& w : chosen.workloads)
    if (!names.insert(w.name).second)
      chosen.add_problems({failure("two workloads are named " + w.name + "; files are named by their stems")},
                          ExitCode::Usage);
}

Chosen choose(const std::vector<std::string>& asked) {
  Chosen chosen;
  for (const std::string& name : asked.empty() ? workload_names() : asked)
    is_workload_file(name) ? add_file(name, chosen) : add_named(name, chosen);
  ask_for_different_names(chosen);
  return chosen;
}

ExitCode write_scenes(std::vector<Workload> workloads, const BenchCommand& command) {
  std::error_code error;
  std::filesystem::create_directories(*command.write_to, error);
  for (std::size_t count = 1000; count <= command.settings.largest_scaling; count *= 10)
    for (Workload& w : std::array{strands(count), tufts(count)}) workloads.push_back(std::move(w));
  for (const Workload& w : workloads)
    if (auto status = write_scene(w, command.settings.size, *command.write_to / (w.name + ".yaml")); !status)
      return report(status.why(), ExitCode::CannotCreate);
  return ExitCode::Ok;
}

}  // namespace

ExitCode run(const BenchCommand& command) {
  Chosen chosen = choose(command.workloads);
  if (chosen.code != ExitCode::Ok) return report(chosen.problems, chosen.sources, chosen.code);
  if (command.write_to) return write_scenes(std::move(chosen.workloads), command);
  if (!command.json) say(bench_text(command.settings));
  const auto figures = run_benchmark(
      chosen.workloads, command.settings, [](const std::string& what) { complain(what + '\n'); },
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
