// What a benchmark found, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "renderer/bench/benchmark.h"

namespace marrow {

/// What is measured, and a paragraph for a workload.
std::string bench_text(const BenchSettings&);
std::string bench_text(const WorkloadFigures&);

/// One object; the names of figures end with their unit. null: there is no answer, or the times are too short to tell.
/// After a request to stop it has `interrupted`.
std::string bench_json(const BenchSettings&, const std::vector<WorkloadFigures>&);

}  // namespace marrow
