// The table of all kinds of nodes. A new kind is its own file and one row here.
#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "field/tree/nodes/crisp.h"
#include "field/tree/nodes/ricci.h"
#include "field/tree/nodes/sphere.h"
#include "field/tree/nodes/twist.h"

namespace marrow {

/// Documentation lists them in this order.
using AnyNode = std::variant<  //
    Sphere,                    // primitives
    Intersection, Difference,  // set operations
    Ricci,                     // blends
    Twist>;                    // warps

struct BoxedNode {
  AnyNode node;
};
inline std::shared_ptr<const BoxedNode> boxed(AnyNode node) {
  return std::make_shared<const BoxedNode>(BoxedNode{std::move(node)});
}

inline const NodeInfo& info_of(const AnyNode& node) {
  return std::visit([]<class Kind>(const Kind&) -> const NodeInfo& { return Kind::info; }, node);
}

}  // namespace marrow
