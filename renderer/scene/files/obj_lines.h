// Curves in Wavefront OBJ: `v` positions joined by `l`.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/files/skeleton_options.h"

namespace marrow {

/// The lines (`l`) and points (`p`) of an OBJ file; faces, normals and the rest are left out. Indices count from 1, or
/// back from the last vertex when negative; `7/3` is vertex 7; `\` at the end joins a line to the next. A vertex where
/// lines meet is one place; closed lines end in a second node where they began. Without `radius` the fourth number of
/// each vertex in use is its radius. Errors: every statement that is wrong, up to 20; vertices that do not exist; no
/// radius; no line and no point.
Result<SkeletonFile> read_obj_lines(std::string_view text, const SkeletonOptions&, const std::string& name);

}  // namespace marrow
