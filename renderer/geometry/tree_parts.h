// What of a general tree goes by the tracers of its blends, under set operations, and what is left to the general one.
#pragma once

#include <optional>
#include <vector>

#include "field/math/box3.h"
#include "field/tree/field_tree.h"
#include "field/tree/set_expression.h"

namespace marrow {

/// Blends of many skeletons under crisp or sharp unions, intersections and differences, and under other operators that
/// leave most of them as they are.
struct CombinedBlends {
  FieldTree whole;
  Box3 bounds;  ///< of its surface
  SetExpression expression;
};

struct TreeParts {
  std::vector<CombinedBlends> combined;
  std::optional<FieldTree> rest;
};

/// The members of a tree. At most some hundred become CombinedBlends: each is a solid of its own.
TreeParts take_apart(const FieldTree&);

}  // namespace marrow
