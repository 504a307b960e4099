// Workloads from files.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/bench/workload.h"

namespace marrow {

/// Whether the ending is one that read_workload() knows, in any case: .txt, and those of skeleton files.
bool is_workload_file(const std::string& name);

/// These endings, for people.
inline constexpr std::string_view workload_endings =
    ".txt, .swc, .obj, .csv, .tsv, .xyz, .extxyz, .pdb, .ent and .hair";

/// What a reader makes of a file.
struct WorkloadFile {
  Workload workload;
  Diagnostics warnings;
};

/// .txt: the common text of this workload's peers, a statement a line, blanks between, # begins a comment:
///
///     cam    x y z  t                    the eye; tangent of half the angle of view
///     light  x y z                       towards the sun
///     seg    x y z r  x y z r  [s]       two ends, each with its radius
///     pt     x y z r  [s]
///
/// s is a strength that only blobs use; like a radius it is above 0. Without `cam` the camera looks at all of it from
/// +z, without `light` the sun is that of w1. Any other ending: the skeleton of that file (skeleton_file.h). The
/// workload is named after the file. Errors: every line that is wrong, also for a scene, up to 20; nothing to draw;
/// more than one `cam` or `light`.
Result<WorkloadFile> read_workload(std::string_view bytes, const std::string& name);

}  // namespace marrow
