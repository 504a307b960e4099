// marrow bench: the program and its peers on common scenes.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "renderer/app/command_line/commands.h"
#include "renderer/app/machine/interrupt.h"
#include "renderer/app/report/bench_report.h"
#include "renderer/app/report/report.h"
#include "renderer/app/text/print.h"
#include "renderer/bench/dual_mesh.h"
#include "renderer/bench/workload.h"
#include "renderer/bench/workload_reader.h"
#include "renderer/output/atomic_file.h"
#include "renderer/scene/input_files.h"
#include "renderer/scene/source_cache.h"

namespace marrow {
namespace {

namespace fs = std::filesystem;

struct Chosen {
  std::vector<Workload> workloads;
  SourceCache sources;
  Diagnostics problems, warnings;
  ExitCode code = ExitCode::Ok;  // of the first problem

  void add_problems(const Diagnostics& more, ExitCode why) {
    if (code == ExitCode::Ok) code = why;
    problems.insert(problems.end(), more.begin(), more.end());
  }
};

// A name with a folder or an ending means a file, whether it is there or not.
bool is_name_of_file(const std::string& name) {
  std::error_code error;
  const fs::path path(name);
  return path.has_parent_path() || path.has_extension() || fs::exists(path, error);
}

Diagnostic not_a_skeleton(const std::string& name) {
  const auto ending = fs::path(name).extension();
  if (ending == ".yaml" || ending == ".yml")
    return with_hint(
        failure(fmt::format("`{}` is a scene by its name, and bench measures skeletons and workloads", name)),
        fmt::format("marrow render {} makes its picture, and tells the time", name));
  return with_hint(
      failure(fmt::format("`{}` is no skeleton by its name", name)),
      fmt::format("bench takes {}, and files that end with {}", fmt::join(workload_names(), ", "), workload_endings));
}

void add_file(const std::string& name, Chosen& chosen) {
  auto file = InputFiles().read(name);
  if (!file) return chosen.add_problems(file.why(), ExitCode::NoInput);
  if (!is_workload_file(name)) return chosen.add_problems({not_a_skeleton(name)}, ExitCode::Usage);
  auto read = read_workload(file->bytes, name);
  chosen.sources.add(name, std::move(file->bytes));
  if (!read) return chosen.add_problems(read.why(), ExitCode::BadInput);
  chosen.warnings.insert(chosen.warnings.end(), read->warnings.begin(), read->warnings.end());
  chosen.workloads.push_back(std::move(read->workload));
}

void add_named(const std::string& name, Chosen& chosen) {
  auto workload = workload_named(name);
  if (!workload) return chosen.add_problems(workload.why(), ExitCode::Usage);
  chosen.workloads.push_back(std::move(*workload));
}

bool is_known(const std::string& name) {
  const auto names = workload_names();
  return std::ranges::find(names, name) != names.end();
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
    !is_known(name) && is_name_of_file(name) ? add_file(name, chosen) : add_named(name, chosen);
  ask_for_different_names(chosen);
  return chosen;
}

// What each option by itself may be, and they together may not.
Diagnostics objections(const BenchSettings& settings) {
  Diagnostics found;
  if (settings.many_samples && !settings.processes)
    found.push_back(failure("--long asks for longer processes, and --no-processes for none: one of them is enough"));
  return found;
}

// The grid of --mesh over each workload.
Diagnostics grids_too_fine(const Chosen& chosen, const BenchSettings& settings) {
  Diagnostics found;
  if (!settings.mesh_spacing || *settings.mesh_spacing == 0) return found;
  for (const Workload& w : chosen.workloads)
    if (const double finest = finest_mesh_spacing(w.extent()); *settings.mesh_spacing < finest)
      found.push_back(with_hint(
          failure(fmt::format("--mesh: a grid of {} scene units is too fine for {}", *settings.mesh_spacing, w.name)),
          fmt::format("its finest grid that fits in memory is --mesh {:.6g}; --mesh 0 leaves the mesh out", finest)));
  return found;
}

Status make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    return failure(fmt::format("`{}` is a file, not a folder", folder.string()));
  fs::create_directories(folder, error);
  if (error) return failure(fmt::format("cannot make the folder `{}`: {}", folder.string(), error.message()));
  return Done{};
}

// What stands there is replaced by whole files alone; the scene comes after what it needs.
Status put_scene(const Workload& w, int film_size, const fs::path& folder) {
  const SceneText text = scene_text(w, film_size, w.name + ".swc");
  const auto put = [&](const char* ending, const std::string& of) {
    return write_file_atomically(folder / (w.name + ending), std::as_bytes(std::span(of)));
  };
  if (!text.skeleton.empty())
    if (auto status = put(".swc", text.skeleton); !status) return status;
  return put(".yaml", text.scene);
}

ExitCode write_scenes(std::vector<Workload> workloads, const BenchCommand& command) {
  if (auto status = make_folder(*command.write_to); !status) return report(status.why(), ExitCode::CannotCreate);
  for (std::size_t count = 1000; count <= command.settings.largest_scaling; count *= 10)
    for (Workload& w : std::array{strands(count), tufts(count)}) workloads.push_back(std::move(w));
  const auto& interrupted = interruption_flag();
  for (const Workload& w : workloads) {
    if (interrupted) return complain("interrupted; the others are not written\n"), ExitCode::Interrupted;
    if (auto status = put_scene(w, command.settings.size, *command.write_to); !status)
      return report(status.why(), ExitCode::CannotCreate);
    complain(fmt::format("wrote {}\n", (*command.write_to / (w.name + ".yaml")).string()));
  }
  return ExitCode::Ok;
}

std::string closing_line(const std::vector<WorkloadFigures>& finished) {
  std::vector<std::string> names;
  for (const WorkloadFigures& w : finished) names.push_back(w.name);
  return names.empty() ? "interrupted; nothing was finished\n"
                       : fmt::format("interrupted; finished {}\n", fmt::join(names, ", "));
}

// What has the name of a workload is its mistake; what has none is about temporary files.
ExitCode exit_code_of(const Diagnostic& why) {
  return why.where.file.empty() ? ExitCode::CannotCreate : ExitCode::BadInput;
}

ExitCode measure(const std::vector<Workload>& workloads, const BenchCommand& command) {
  BenchSettings settings = command.settings;
  settings.stop = {&interruption_flag()};
  if (!command.json) say(bench_text(settings));
  const auto figures = run_benchmark(
      workloads, settings, [](const std::string& what) { complain(what + '\n'); },
      [&](const WorkloadFigures& w) {
        if (command.json) return;
        say(bench_text(w));
        std::fflush(stdout);
      });
  if (!figures) return report(figures.why(), exit_code_of(figures.why().front()));
  if (command.json) say(bench_json(settings, *figures));
  if (!settings.stop.is_made()) return ExitCode::Ok;
  complain(closing_line(*figures));
  return ExitCode::Interrupted;
}

}  // namespace

ExitCode run(const BenchCommand& command) {
  if (const auto found = objections(command.settings); !found.empty()) return report(found, ExitCode::Usage);
  Chosen chosen = choose(command.workloads);
  report(chosen.warnings, chosen.sources, ExitCode::Ok);
  if (chosen.code != ExitCode::Ok) return report(chosen.problems, chosen.sources, chosen.code);
  if (const auto found = grids_too_fine(chosen, command.settings); !found.empty())
    return report(found, ExitCode::Usage);
  if (command.write_to) return write_scenes(std::move(chosen.workloads), command);
  return measure(chosen.workloads, command);
}

}  // namespace marrow
