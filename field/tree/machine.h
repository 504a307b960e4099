// Walks a tree of nodes with stacks of its own, over any type of number.
#pragma once

#include <vector>

#include "field/tree/blend_values.h"
#include "field/tree/field_tree.h"
#include "field/tree/tree_node.h"

namespace marrow::tree {

template <class Node, class X>
concept Primitive = requires(const Node& n, const Vec3<X>& p) {
  n.value(p);
};
template <class Node, class X>
concept Operator = requires(const Node& n, std::span<const X> f) {
  n.value(f);
};
template <class Node, class X>
concept Warp = requires(const Node& n, const Vec3<X>& p) {
  n.child_point(p);
};

/// A warp that takes some boxes to several places.
template <class Node, class X>
concept CutWarp = requires(const Node& n, const Vec3<X>& p, typename Node::template Sides<X>& places) {
  n.sides(p, places);
};

template <Number X>
bool misses(const Box3& box, const Vec3<X>& p) {
  for (std::size_t i = 0; i < 3; ++i)
    if (upper(p[i]) < box.lower[i] || lower(p[i]) > box.upper[i]) return true;
  return false;
}

/// The field of a warp from that of its child at each place.
template <Number X>
X of_all_sides(std::span<const X> places) {
  X all = places[0];
  if constexpr (is_enclosure<X>) {
    if (places.size() > 1) all = any_slope<X>(value_of(all));
    for (const X& place : places.subspan(1)) all = hull(all, place);
  }
  return all;
}

template <Number X>
X value_of_node(const TreeNode& node, const Place<X>& at, std::span<const X> children) {
  return std::visit(
      [&]<class Node>(const Node& n) -> X {
        if constexpr (std::same_as<Node, BlendLeaf>) return blend_value(*n.field, at);
        else if constexpr (Primitive<Node, X>) return n.value(at.p);
        else if constexpr (Warp<Node, X>) return of_all_sides(children);
        else return n.value(children);
      },
      node);
}

/// The same of a record, whose blend may be summed as the part of space of its tree allows.
template <Number X>
X value_of_record(const FieldTree& tree, const FieldTree::Record& record, const Place<X>& at,
                  std::span<const X> children) {
  if constexpr (requires { blend_value(*record.local, at); })
    if (record.local) return blend_value(*record.local, at);
  return value_of_node(tree.node(record), at, children);
}

inline bool is_warp(const TreeNode& node) {
  return std::visit([]<class Node>(const Node&) { return Warp<Node, double>; }, node);
}

template <Number X>
Vec3<X> point_of_children(const TreeNode& node, const Vec3<X>& p) {
  return std::visit(
      [&]<class Node>(const Node& n) -> Vec3<X> {
        if constexpr (Warp<Node, X>) return n.child_point(p);
        else return p;
      },
      node);
}

/// Adds the further places of a child that stands behind a cut; returns where it is first.
template <Number X>
Vec3<X> points_of_children(const TreeNode& node, const Vec3<X>& p, std::vector<Vec3<X>>& further) {
  return std::visit(
      [&]<class Node>(const Node& n) -> Vec3<X> {
        if constexpr (CutWarp<Node, X>) {
          typename Node::template Sides<X> places;
          if (const std::size_t count = n.sides(p, places); count > 0) {
            further.insert(further.end(), places.begin() + 1, places.begin() + static_cast<std::ptrdiff_t>(count));
            return places[0];
          }
        }
        if constexpr (Warp<Node, X>) return n.child_point(p);
        else return p;
      },
      node);
}

/// The same of a place; where it becomes several, no middle is known of any.
template <Number X>
Place<X> place_of_children(const TreeNode& node, const Place<X>& at, std::vector<Vec3<X>>& further) {
  if (!is_warp(node)) return at;
  const std::size_t before = further.size();
  const Vec3<X> inner = points_of_children(node, at.p, further);
  if constexpr (is_enclosure<X> && JetNumber<X>)
    if (at.knows_middle && further.size() == before) return at.moved(inner, point_of_children(node, at.middle));
  return inner;
}

/// Calls visit(record index, place, values of its children) -> value for `start` and every node below that p's support
/// test leaves, children first; `none` stands for the others. A child behind a cut has a value for each of its places,
/// where values are numbers. The stacks are kept between calls.
template <Number X, class Value>
class Machine {
 public:
  template <class Visit>
  Value run(const FieldTree& tree, std::uint32_t start, const Vec3<X>& p, const Value& none, const Visit& visit) {
    frames_.clear();
    values_.clear();
    further_.clear();
    if (tree.records().empty()) return none;
    enter(tree, start == FieldTree::whole ? tree.root() : start, Place<X>::outermost(p), none);
    while (!frames_.empty()) {
      Frame& top = frames_.back();
      const FieldTree::Record& record = tree.records()[top.record];
      if (top.next < record.child_count) {
        const std::uint32_t child = tree.children(record)[top.next++];
        const Place<X> at = top.inner;
        enter(tree, child, at, none);
        continue;
      }
      if (further_.size() > top.further) {  // the same child at its next place
        const Vec3<X> at = further_.back();
        further_.pop_back();
        enter(tree, tree.children(record)[0], at, none);
        continue;
      }
      const std::span<const Value> children = std::span(values_).subspan(top.values);
      const Value v = visit(top.record, top.outer, children);
      values_.resize(top.values);
      values_.push_back(v);
      frames_.pop_back();
    }
    return values_.back();
  }

 private:
  struct Frame {
    std::uint32_t record, next;
    std::size_t values, further;  // how much of the stacks belongs to those above
    Place<X> outer, inner;        // in the node's coordinates and in its children's
  };
  void enter(const FieldTree& tree, std::uint32_t index, const Place<X>& at, const Value& none) {
    const FieldTree::Record& record = tree.records()[index];
    if (misses(record.support, at.p)) {
      values_.push_back(none);
      return;
    }
    const std::size_t further = further_.size();
    Place<X> inner;
    if constexpr (std::same_as<X, Value>) inner = place_of_children(tree.node(record), at, further_);
    else inner = point_of_children(tree.node(record), at.p);
    frames_.push_back({index, 0, values_.size(), further, at, inner});
  }

  std::vector<Frame> frames_;
  std::vector<Value> values_;
  std::vector<Vec3<X>> further_;
};

}  // namespace marrow::tree
