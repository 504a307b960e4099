// Whole processes in turns: this program, and POV-Ray where it is installed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "renderer/bench/benchmark.h"
#include "renderer/bench/workload.h"

namespace marrow {

/// Renders the scene file, and the workload as a blob beside it; fills `processes` and `missing` of the figures.
void race_processes(const Workload&, const BenchSettings&, const std::filesystem::path& scene,
                    const std::function<void(const std::string&)>& tell, WorkloadFigures&);

}  // namespace marrow
