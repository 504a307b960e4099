// Skeletons of neurons, vessels and trees in SWC: one node a line, `id type x y z radius parent`.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/files/skeleton_options.h"

namespace marrow {

/// Accepts several roots, ids in any order, parents after children, CRLF, tabs, comments, further columns and whole
/// numbers written with a point. Nodes keep the order of the file; radii of 0 as NodeList::finish() says. Errors: every
/// line that is wrong, up to 20; a parent that is missing or a circle of parents; a file without nodes or without any
/// radius.
Result<SkeletonFile> read_swc(std::string_view text, const SkeletonOptions&, const std::string& name);

}  // namespace marrow
