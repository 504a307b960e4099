// A workload as POV-Ray's blob: the nearest thing that a common renderer has.
#pragma once

#include <filesystem>

#include "field/base/result.h"
#include "renderer/bench/workload.h"

namespace marrow {

/// A blob of cylinders and spheres, the sum of (1 - d^2 / R^2)^2 over primitives with R twice the mean radius,
/// threshold 0.5625. The strengths are fitted so that the surface lies near the wanted radius where segments follow
/// each other.
Status write_povray_blob(const Workload&, const std::filesystem::path&);

}  // namespace marrow
