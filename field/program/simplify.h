// What of a description can be said in fewer or wider nodes, without changing its field; internal to program/.
#pragma once

#include <optional>

#include "field/description/field_node.h"
#include "field/math/affine.h"

namespace marrow {

/// A lone point, that is a blend of one with the defaults: its field is (radius / distance)^3.
const PointSkeleton* lone_point(const FieldNode&);

/// Where a general node places its only child, if it does no more than that: a shear, by no more than 100, as boxes
/// around what slides farther tell little, and a taper of one width, of no more than 100 or a hundredth.
std::optional<Affine> placement_of(const GeneralNode&);

/// Whether the parent may take the operands of a child in the place of the child itself: f(f(a, b), c) = f(a, b, c).
enum class Absorbs {
  Nothing,
  First,    ///< as its first operand only: what folds from the left
  Anywhere  ///< the order of operands does not matter
};
Absorbs absorbs(const FieldNode& parent, const FieldNode& child);

/// A sum of nothing but lone points, placed by similarities, through any depth of further sums: it is one blend with
/// alpha = pi/2, which has a tracer of its own. Nothing for less than two points, or more than `max_points`.
std::optional<Blend> sum_of_points(const FieldDescription&, FieldNodeId);
inline constexpr std::size_t max_points_of_sum = 10'000'000;

}  // namespace marrow
