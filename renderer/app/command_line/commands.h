// What can be asked of the program: one struct a sub-command, and one function that does it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "renderer/app/command_line/crop.h"
#include "renderer/app/command_line/exit_code.h"
#include "renderer/bench/benchmark.h"
#include "renderer/slice/slice.h"

namespace marrow {

struct SceneInput {
  std::filesystem::path path;
  std::vector<std::string> overrides;  ///< "path.to.value=text", as ReadOptions takes them
};

enum class ProgressStyle { None, Auto, Bar, Plain, Json };

struct RenderCommand {
  SceneInput scene;
  std::optional<std::filesystem::path> output,
      png;  ///< neither: SCENE's stem with .exr and .png, in the current folder
  std::optional<int> samples_per_pixel;
  std::optional<double> time_limit_s;
  std::optional<std::uint64_t> seed;
  std::optional<Crop> crop;
  int threads = 0;         ///< 0: all that the process may use
  std::string isa;         ///< empty: the best of this machine
  std::string embree_isa;  ///< empty: as `isa`
  int tile_size = 32;
  bool eager = false;  ///< cells are made ready before the first ray
  std::string view;
  std::optional<std::filesystem::path> ocio;
  ProgressStyle progress = ProgressStyle::Auto;
  bool strict = false;
};

struct CheckCommand {
  SceneInput scene;
  bool json = false;
};

struct SchemaCommand {
  bool markdown = false;
};

struct ProbeCommand {
  SceneInput scene;
  std::optional<std::string> object;
  std::filesystem::path points;  ///< "-": standard input
  bool curvature = false;        ///< the Hessian too
  bool materials = false;        ///< the weights of materials too
  int threads = 0;               ///< 0: all that the process may use
};

struct TraceCommand {
  SceneInput scene;
  std::filesystem::path rays;  ///< "-": standard input
  bool occluded = false;       ///< only whether anything is in the way
  int threads = 0;             ///< 0: all that the process may use
  std::string isa;             ///< empty: the best of this machine
  bool strict = false;
};

struct InfoCommand {
  SceneInput scene;
  bool json = false;
  int threads = 0;
};

struct SliceCommand {
  SceneInput scene;
  std::optional<std::string> object;
  std::filesystem::path output = "slice.png";
  SliceRequest request;
};

struct BenchCommand {
  std::vector<std::string> workloads;  ///< names, or files that read_workload() knows; empty: all that have names
  BenchSettings settings;
  bool json = false;
  std::optional<std::filesystem::path> write_to;  ///< a folder: scene files are written there and nothing is run
};

using Command = std::variant<RenderCommand, CheckCommand, SchemaCommand, ProbeCommand, TraceCommand, InfoCommand,
                             SliceCommand, BenchCommand>;

ExitCode run(const RenderCommand&);
ExitCode run(const CheckCommand&);
ExitCode run(const SchemaCommand&);
ExitCode run(const ProbeCommand&);
ExitCode run(const TraceCommand&);
ExitCode run(const InfoCommand&);
ExitCode run(const SliceCommand&);
ExitCode run(const BenchCommand&);

}  // namespace marrow
