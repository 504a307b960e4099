// Workloads from files.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/bench/workload.h"

namespace marrow {

/// Whether the ending is one that read_workload() knows: .txt, and those of skeleton files.
bool is_workload_file(const std::string& name);

/// .txt: the common text of this workload's peers, a statement a line, blanks between, # begins a comment:
///
///     cam    x y z  t                    the eye; half the side of the picture at distance 1 (tangent of half its
///     angle) light  x y z                       towards the sun seg    x y z r  x y z r  [s]       two ends, each with
///     its radius pt     x y z r  [s]
///
/// s is a strength that only blobs use. Without `cam` the camera looks at all of it from +z, without `light` the sun is
/// that of w1. Any other ending: the skeleton of that file (skeleton_file.h). The workload is named after the file.
/// Errors: every line that is wrong, up to 20; nothing to draw; more than one `cam` or `light`.
Result<Workload> read_workload(std::string_view bytes, const std::string& name);

}  // namespace marrow
