// Skeletons of neurons, vessels and trees in SWC: one node a line, `id type x y z radius parent`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "field/base/result.h"
#include "field/description/field_node.h"

namespace marrow {

struct SwcOptions {
  double scale = 1;                  ///< multiplies positions and radii
  std::optional<double> min_radius;  ///< after scaling; thinner nodes get this radius
};

struct SwcSkeleton {
  SkeletonGraph graph;  ///< nodes in the order of the file
  Diagnostics warnings;
};

/// Accepts several roots, ids in any order, parents after children, CRLF, tabs, comments, further columns and whole
/// numbers written with a point. A radius of 0 (of a node whose thickness is unknown) becomes min_radius or, without
/// one, the smallest radius above 0 of the file, with one warning. Errors: every line that is wrong, up to 20; a
/// parent that is missing or a circle of parents; a file without nodes or without any radius.
Result<SwcSkeleton> read_swc(std::string_view text, const SwcOptions&, const std::string& name);

}  // namespace marrow
