// What a benchmark found, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "renderer/bench/benchmark.h"

namespace marrow {

/// A paragraph for each workload.
std::string bench_text(const BenchSettings&, const std::vector<WorkloadFigures>&);

/// One object; the names of figures end with their unit.
std::string bench_json(const BenchSettings&, const std::vector<WorkloadFigures>&);

}  // namespace marrow
