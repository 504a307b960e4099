// The first crossing of a surface along a piece of a ray, found with enclosures as tree_tracer.h tells [Moore 1966].
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "field/math/ray.h"
#include "field/tree/field_tree.h"

namespace marrow {

/// Fields are not known any better than to this: rounding of sums over all primitives (3e-11 of them), with a margin.
constexpr double sums_are_off = 1e-10;

struct CrossingSearch {
  std::optional<double> t;                                     ///< of the crossing
  double undecided = std::numeric_limits<double>::infinity();  ///< where the first gap begins that nothing could decide
  double undecided_until = 0;                                  ///< where the last one ends
  std::uint32_t evaluations = 0;
};

/// Searches begin <= t <= end for the first change of side; with `any`, for any. A crossing is placed to some ulps.
/// Of the field below `record`, or of FieldTree::whole. Gaps of 2^-34 of the size of the body, or of coordinates if
/// those are less, are too short to decide, and of 2^-48 of coordinates and the way from the ray's origin.
CrossingSearch find_crossing(const FieldTree&, std::uint32_t record, const Ray&, double begin, double end, double body,
                             bool any);

}  // namespace marrow
