// Whole processes in turns: this program, and POV-Ray where it is installed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "renderer/bench/benchmark.h"
#include "renderer/bench/workload.h"

namespace marrow {

/// Renders the scene file, and the workload as a blob beside it; fills `processes` and `missing` of the figures. Where
/// POV-Ray cannot take as many samples as are asked for, Marrow runs once more with as many as POV-Ray takes.
void race_processes(const Workload&, const BenchSettings&, const std::filesystem::path& scene,
                    const std::function<void(const std::string&)>& tell, WorkloadFigures&);

/// The side k of the grid with which POV-Ray comes nearest to so many samples (2 or more) of each pixel: it takes one
/// in the pixel's middle, then k x k, and the mean of all of them. k is from 1 to 9; larger ones it takes as 9.
/// [counted, and read from a picture, with version 3.7 and +AM1 +A0.0]
int povray_grid(int samples);
inline int samples_of_povray_grid(int k) { return k * k + 1; }

}  // namespace marrow
