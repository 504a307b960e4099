// Graphs of subdivision curves, and skeletons with fewer nodes.
#pragma once

#include <cstdint>
#include <span>

#include "field/description/field_node.h"

namespace marrow {

/// Each branch of the skeleton (branches.h) as a subdivision curve: it keeps its ends, and so all junctions, while the
/// joints between are smoothed with their radii; closed branches are smoothed all around, and nodes in `sticking` stay.
/// 0 levels give the same field. Precondition: a valid skeleton.   [Cani and Hornus 2001, sec. 3.1]
SkeletonGraph subdivide(const SkeletonGraph&, Subdivision, int levels, std::span<const std::int32_t> sticking = {});

/// Leaves out nodes within branches as long as no node, and no radius at a node, is farther than `tolerance` from the
/// segment that replaces it. Ends of branches stay.   [Douglas and Peucker 1973]
SkeletonGraph simplify(const SkeletonGraph&, double tolerance);

}  // namespace marrow
