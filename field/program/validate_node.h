// Checks the parameters of a general node against the forms it declares.
#pragma once

#include <string>
#include <vector>

#include "field/tree/any_node.h"

namespace marrow {

struct NodeProblem {
  std::string message, hint;
};

/// Everything wrong with a node of `children` children; numbers out of range, vectors that are not finite, wrong
/// counts.
std::vector<NodeProblem> problems_of(const AnyNode&, std::size_t children);

}  // namespace marrow
