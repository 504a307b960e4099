#include "field/program/crisp_surface.h"

#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include "field/base/overloaded.h"
#include "field/tree/any_node.h"

namespace marrow {
namespace {

// What is inside it, and so its surface, depends on nothing but what is inside its children: set operations, warps.
bool only_asks_for_insides(const AnyNode& node) {
  return std::visit(Overloaded{[](const Intersection&) { return true; }, [](const Difference&) { return true; },
                               [](const SharpUnion&) { return true; }, [](const SharpIntersection&) { return true; },
                               [](const SharpDifference&) { return true; }, [](const Twist&) { return true; },
                               [](const Taper&) { return true; }, [](const Bend&) { return true; },
                               [](const Shear&) { return true; }, [](const auto&) { return false; }},
                    node);
}

bool only_asks_for_insides(const FieldNode& node) {
  return std::visit(Overloaded{[](const Union&) { return true; }, [](const Transform&) { return true; },
                               [](const GeneralNode& n) { return only_asks_for_insides(n.node->node); },
                               [](const auto&) { return false; }},
                    node.what);
}

// Fields that it sees as they are.
void for_each_child(const FieldNode& node, const auto& visit) {
  std::visit(Overloaded{[](const Primitive&) {}, [&](const Transform& t) { visit(t.of); },
                        [&](const Blend& b) {
                          for (const FieldNodeId child : b.of) visit(child);
                          if (const auto* angle = std::get_if<AlphaFromField>(&b.alpha)) visit(angle->field);
                        },
                        [&](const auto& group) {
                          for (const FieldNodeId child : group.of) visit(child);
                        }},
             node.what);
}

std::optional<FieldNode> crisp(const FieldNode& node) {
  const auto* general = std::get_if<GeneralNode>(&node.what);
  if (general == nullptr) return {};
  FieldNode made{.what = *general, .where = node.where};
  auto& copy = std::get<GeneralNode>(made.what);
  const AnyNode& kind = general->node->node;
  if (std::holds_alternative<SharpUnion>(kind)) made.what = Union{general->of};
  else if (std::holds_alternative<SharpIntersection>(kind)) copy.node = boxed(Intersection{});
  else if (std::holds_alternative<SharpDifference>(kind)) copy.node = boxed(Difference{});
  else return {};
  return made;
}

}  // namespace

std::optional<FieldDescription> crisp_surface(const FieldDescription& field) {
  std::optional<FieldDescription> made;
  // Parents stand behind their children: by the time a node comes, all that see it have been asked.
  std::vector<bool> is_seen_as_field(field.nodes.size(), false);
  for (std::size_t i = field.nodes.size(); i-- > 0;) {
    const FieldNode& node = field.nodes[i];
    if (is_seen_as_field[i] || !only_asks_for_insides(node)) {
      for_each_child(node, [&](FieldNodeId child) { is_seen_as_field[child.index()] = true; });
    } else if (auto simple = crisp(node)) {
      if (!made) made = field;
      made->nodes[i] = std::move(*simple);
    }
  }
  return made;
}

}  // namespace marrow
