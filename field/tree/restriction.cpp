// What is left of a tree in a part of space.
#include <algorithm>
#include <concepts>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "field/number/places_in.h"
#include "field/tree/field_tree.h"
#include "field/tree/machine.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;

template <class Node, class... Kinds>
constexpr bool is_any_of = (std::same_as<Node, Kinds> || ...);

// What a node is inside the box: bounds, and the record in the new tree that stands for it.
struct Part {
  static constexpr std::uint32_t none = 0xffffffff;
  Interval value;
  std::uint32_t record = none;  ///< none: 0 all over the box
};

class Restriction {
 public:
  Restriction(const FieldTree& tree, bool with_local_blends) : tree_(tree), with_local_blends_(with_local_blends) {}

  Part add(std::uint32_t index, const Vec3<Interval>& p, std::span<const Part> children) {
    const FieldTree::Record& old = tree_.records()[index];
    const TreeNode& node = tree_.node(old);
    select(node, children);
    if (kept_.size() == 1 && is_idle_with_one(node)) return kept_[0].value == Interval(0) ? Part{} : kept_[0];
    if (kept_.empty() && old.child_count > 0) return {};
    values_.clear();
    for (const Part& c : kept_) values_.push_back(c.value);
    FieldTree::Record made = old;
    if (const auto* blend = std::get_if<BlendLeaf>(&node); blend != nullptr && with_local_blends_)
      made.local = LocalBlend::make(*blend->field, old.local, tree::box_of(p));
    const Interval v = tree::value_of_record<Interval>(tree_, made, p, values_);
    if (v == Interval(0)) return {};
    made.first_child = static_cast<std::uint32_t>(children_.size());
    made.child_count = static_cast<std::uint32_t>(kept_.size());
    for (const Part& c : kept_) children_.push_back(c.record);
    records_.push_back(std::move(made));
    return {v, static_cast<std::uint32_t>(records_.size() - 1)};
  }

  FieldTree tree(std::uint32_t root) && {
    if (root == Part::none) records_.clear();
    else records_.resize(root + 1);  // what stands behind the root was an operand that lost
    return FieldTree(tree_.nodes(), std::move(records_), std::move(children_));
  }

 private:
  // Operators that give a single operand back as it is.
  static bool is_idle_with_one(const TreeNode& node) {
    return std::visit(
        []<class Node>(const Node&) {
          return is_any_of<Node, CrispUnion, Sum, Ricci, Intersection, Difference, SoftUnion, SoftIntersection,
                           SoftDifference, SharpUnion, SharpIntersection, SharpDifference, Contact>;
        },
        node);
  }

  template <class Node>
  static constexpr bool ignores_zeros = requires {
    requires Node::ignores_zeros;
  };

  // The operands that count. An operator that needs all of its operands in place gets zeros as they are.
  void select(const TreeNode& node, std::span<const Part> children) {
    kept_.clear();
    if (std::none_of(children.begin(), children.end(), [](const Part& c) { return c.record != Part::none; })) return;
    std::visit(
        [&]<class Node>(const Node& n) {
          if constexpr (std::same_as<Node, CrispUnion>) keep_largest(children);
          else if constexpr (std::same_as<Node, Intersection>)
            keep_least(children, [](const Part& c) { return c.value; });
          else if constexpr (std::same_as<Node, Difference>) keep_rest(children);
          else if constexpr (is_any_of<Node, SoftUnion, SoftIntersection, SharpUnion, SharpIntersection>)
            keep_joined(n, children);
          else if constexpr (is_any_of<Node, SoftDifference, SharpDifference>) keep_touching(n, children);
          else if constexpr (std::same_as<Node, Contact>) keep_in_contact(n, children);
          else if constexpr (ignores_zeros<Node>)
            std::copy_if(children.begin(), children.end(), std::back_inserter(kept_),
                         [](const Part& c) { return c.record != Part::none; });
          else
            for (const Part& c : children) kept_.push_back(in_place(c));
        },
        node);
  }

  void keep_largest(std::span<const Part> children) {
    double least = -inf;  // an operand below this is never the largest
    for (const Part& c : children) least = std::max(least, c.value.lo);
    for (const Part& c : children)
      if (c.record != Part::none && c.value.hi >= least) kept_.push_back(c);
  }

  // Of terms of which the least counts. Where any is 0 nothing is left.
  void keep_least(std::span<const Part> children, const auto& term) {
    double most = inf;  // an operand above this is never the least
    for (const Part& c : children) most = std::min(most, term(c).hi);
    for (const Part& c : children)
      if (term(c).lo <= most) kept_.push_back(in_place(c));
  }

  // min(f_1, 2 - f_i): several i whose field is 0 count as one, and as none where f_1 is at most 2. (That is so above
  // any such cut: a chain of them keeps one.)
  void keep_rest(std::span<const Part> children) {
    const double first = children[0].value.hi;
    double most = first;
    for (const Part& c : children.subspan(1)) most = std::min(most, complement(c.value).hi);
    if (children[0].record == Part::none) return;
    kept_.push_back(children[0]);
    bool has_zero = false;
    for (const Part& c : children.subspan(1)) {
      const bool is_zero = c.record == Part::none;
      const double least = complement(c.value).lo;
      if (least >= first || least > most || (is_zero && has_zero)) continue;
      has_zero = has_zero || is_zero;
      kept_.push_back(in_place(c));
    }
  }

  // What is folded into one, but for what leaves the rest as it is, or the rest where it is left by that. Of a union
  // what is 0 all over the box counts as nothing.
  template <class Node>
  void keep_joined(const Node& node, std::span<const Part> children) {
    Interval rest(0);
    for (const Part& c : children) {
      const bool is_first = kept_.empty();
      if (ignores_zeros<Node> && c.record == Part::none) continue;
      if (!is_first && node.spares(rest, c.value)) continue;
      if (!is_first && node.replaces(rest, c.value)) kept_.clear();
      const Interval both[] = {rest, c.value};
      rest = kept_.empty() ? c.value : node.value(std::span<const Interval>(both));
      kept_.push_back(in_place(c));
    }
  }

  void keep_in_contact(const Contact& node, std::span<const Part> children) {
    values_.clear();
    for (const Part& c : children) values_.push_back(c.value);
    const std::vector<bool> counts = node.counts(values_);
    for (std::size_t i = 0; i < children.size(); ++i)
      if (counts[i]) kept_.push_back(in_place(children[i]));
  }

  // What is folded onto the first operand without touching it anywhere in the box.
  void keep_touching(const auto& node, std::span<const Part> children) {
    if (children[0].record == Part::none) return;
    kept_.push_back(children[0]);
    Interval rest = children[0].value;
    for (const Part& c : children.subspan(1)) {
      if (node.spares(rest, c.value)) continue;
      const Interval both[] = {rest, c.value};
      rest = node.value(std::span<const Interval>(both));
      kept_.push_back(in_place(c));
    }
  }

  Part in_place(const Part& c) { return c.record == Part::none ? nothing() : c; }

  // An empty union is 0 everywhere.
  Part nothing() {
    if (zero_ == Part::none) {
      FieldTree::Record r;
      r.node = FieldTree::index_of_union;
      r.support = Box3{};
      records_.push_back(r);
      zero_ = static_cast<std::uint32_t>(records_.size() - 1);
    }
    return {Interval(0), zero_};
  }

  const FieldTree& tree_;
  bool with_local_blends_;
  std::vector<FieldTree::Record> records_;
  std::vector<std::uint32_t> children_;
  std::vector<Part> kept_;
  std::vector<Interval> values_;
  std::uint32_t zero_ = Part::none;
};

BoundedTree restriction(const FieldTree& tree, const Box3& box, std::uint32_t below, bool with_local_blends) {
  const Vec3<Interval> p = places_in(box);
  Restriction restriction(tree, with_local_blends);
  tree::Machine<Interval, Part> machine;
  const Part root =
      machine.run(tree, below, p, Part{},
                  [&](std::uint32_t record, const tree::Place<Interval>& at, std::span<const Part> children) {
                    return restriction.add(record, at.p, children);
                  });
  return {std::move(restriction).tree(root.record), root.value};
}

}  // namespace

std::size_t operands_that_may_go(const FieldTree& tree) {
  std::size_t count = 0;
  for (const FieldTree::Record& r : tree.records()) {
    const bool leaves_out = std::visit(
        []<class Node>(const Node&) {
          return is_any_of<Node, CrispUnion, Intersection, Difference, SoftUnion, SoftIntersection, SoftDifference,
                           SharpUnion, SharpIntersection, SharpDifference, Contact>;
        },
        tree.node(r));
    if (leaves_out) count += r.child_count;
  }
  return count;
}

FieldTree restricted(const FieldTree& tree, const Box3& box, std::uint32_t below) {
  return restriction(tree, box, below, false).tree;
}

BoundedTree restricted_and_bounded(const FieldTree& tree, const Box3& box) {
  return restriction(tree, box, FieldTree::whole, false);
}

FieldTree localized(const FieldTree& tree, const Box3& box, std::uint32_t below) {
  return restriction(tree, box, below, true).tree;
}

}  // namespace marrow
