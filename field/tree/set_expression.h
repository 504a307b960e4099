// A tree as crisp or sharp set operations on others: which of them a place is inside of tells whether it is inside the
// whole.
//
// With an operand for each part that a tracer of its own knows better, the surface of the whole is made of pieces of
// the surfaces of its operands: where, as the other operands stand there, one of them decides.
//
// What is below another operator, such as a soft union, is an operand as a whole; and a blend in it is one, too, where
// it decides by itself (blend_in_tree.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "field/math/affine.h"
#include "field/math/box3.h"
#include "field/math/side.h"
#include "field/tree/blend_in_tree.h"
#include "field/tree/field_tree.h"

namespace marrow {

struct BlendField;

class SetExpression {
 public:
  /// One blend that stands for itself, at its place; or all the rest below an operation, in world coordinates.
  struct Operand {
    std::shared_ptr<const BlendField> blend;  ///< null: `tree` is it
    Affine world_from_blend;
    FieldTree tree;
    /// Of a tree: its blend, which is the operand before this one, and decides instead where it can.
    std::shared_ptr<const BlendInTree> lent;
  };

  using StandsAlone = std::function<bool(const BlendField&)>;
  /// Of a tree, or of what stands below a record of it: unions, intersections and differences, crisp or sharp ones,
  /// which have the same surface, with those blends as operands that are said to stand alone, and other operators on
  /// one of them that leave most of its surface as it is. None where it holds no such blend, or more than an expression
  /// is for (most_nodes, most_beside).
  static std::optional<SetExpression> of(const FieldTree&, std::uint32_t record, const StandsAlone&);
  /// The same of each of many records, at once.
  static std::vector<std::optional<SetExpression>> of(const FieldTree&, std::span<const std::uint32_t> records,
                                                      const StandsAlone&);

  static constexpr std::size_t most_nodes = 64;    ///< operations and operands: all are asked at each crossing
  static constexpr std::size_t most_beside = 512;  ///< primitives, all of which are summed at each crossing

  const std::vector<Operand>& operands() const { return operands_; }
  /// Whether the whole is inside where the operand is outside.
  bool is_taken_away(std::size_t operand) const { return paths_[operand].is_taken_away; }

  /// Whether it is a blend that is lent: only in places does it decide by itself.
  bool is_lent(std::size_t operand) const { return paths_[operand].is_lent; }

  /// The side of the whole, all over a box, from those of its operands, side_of(operand), which are asked as far as
  /// needed. Unknown where known ones do not tell.   [strong logic of three values: Kleene 1952]
  template <class SideOf>
  Side side(const Box3& where, const SideOf& side_of) const {
    return side_of_node(root_, where, side_of);
  }

  /// Whether the whole changes sides where the operand does, as the others stand; nothing where known ones do not tell.
  template <class SideOf>
  std::optional<bool> counts(std::size_t operand, const Box3& where, const SideOf& side_of) const {
    bool is_certain = true;
    for (const Condition& c : paths_[operand].conditions) {
      const std::optional<bool> holds = c.holds(*this, where, side_of);
      if (holds == false) return false;
      is_certain = is_certain && holds.has_value();
    }
    return is_certain ? std::optional(true) : std::nullopt;
  }

 private:
  using NodeIndex = std::uint32_t;
  /// A union or intersection of children, an operand, or one whose blend, the operand before it, is lent; `negated`: of
  /// all that is outside it.
  struct Node {
    enum class Kind { Operand, Lender, Union, Intersection } kind = Kind::Operand;
    bool negated = false;
    std::uint32_t operand = 0;
    std::vector<NodeIndex> children;  ///< those that are sooner asked first
    double cost = 0;                  ///< to ask for its side, by its primitives
  };
  /// What must hold of a node beside the way from an operand to the root, so that the operand decides: that it is on
  /// the wanted side (an operand of a union counts where the others are outside). Where no side is wanted: that the
  /// blend, which is lent, decides in the node, which lends it.
  struct Condition {
    NodeIndex node;
    Side wanted;

    template <class SideOf>
    std::optional<bool> holds(const SetExpression& all, const Box3& where, const SideOf& side_of) const {
      if (wanted == Side::Unknown) return all.lent_by(all.nodes_[node]).decides(where);
      const Side side = all.side_of_node(node, where, side_of);
      return side == Side::Unknown ? std::nullopt : std::optional(side == wanted);
    }
  };
  struct Path {
    bool is_taken_away = false, is_lent = false;
    std::vector<Condition> conditions;
  };
  class Reader;

  const BlendInTree& lent_by(const Node& node) const { return *operands_[node.operand].lent; }

  template <class SideOf>
  Side side_of_lender(const Node& node, const Box3& where, const SideOf& side_of) const {
    const BlendInTree& lent = lent_by(node);
    const std::size_t whole = node.operand, blend = whole - 1;
    if (lent.decides(where) == true) return side_of(blend);
    const Side side = lent.side(where, side_of(blend));
    return side != Side::Unknown ? side : side_of(whole);
  }

  template <class SideOf>
  Side side_of_node(NodeIndex index, const Box3& where, const SideOf& side_of) const {
    const Node& node = nodes_[index];
    Side side = Side::Unknown;
    if (node.kind == Node::Kind::Operand) {
      side = side_of(static_cast<std::size_t>(node.operand));
    } else if (node.kind == Node::Kind::Lender) {
      side = side_of_lender(node, where, side_of);
    } else {
      const Side decides = node.kind == Node::Kind::Union ? Side::Inside : Side::Outside;
      side = opposite(decides);
      for (const NodeIndex child : node.children) {
        const Side of_child = side_of_node(child, where, side_of);
        if (of_child == decides) {
          side = decides;
          break;
        }
        if (of_child == Side::Unknown) side = Side::Unknown;
      }
    }
    return node.negated ? opposite(side) : side;
  }
  void find_paths(NodeIndex, bool is_taken_away, const std::vector<Condition>& above);

  std::vector<Node> nodes_;
  NodeIndex root_ = 0;
  std::vector<Operand> operands_;
  std::vector<Path> paths_;  // of operands
};

/// What stands below these records, as a union if there are several, placed in the world.
FieldTree part_of_tree(const FieldTree&, std::span<const std::uint32_t> records, const Affine& world_from_tree);

}  // namespace marrow
