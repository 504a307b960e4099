// Random compiled trees of every kind of node, nested anyhow, with blends, placements, unions and shared children.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "field/tree/field_tree.h"
#include "tests/field/varied_blend.h"
#include "tests/tree/random_node.h"

namespace marrow::test {

class RandomTree {
 public:
  explicit RandomTree(Random& random) : random_(random), nodes_(std::make_shared<std::vector<TreeNode>>()) {
    nodes_->push_back(CrispUnion{});  // as compile() does
  }

  /// A tree of some levels.
  FieldTree make(int levels) {
    add(levels);
    return tree();
  }
  /// One node of a kind over balls.
  template <class Kind>
  FieldTree over_balls(std::size_t count) {
    std::vector<std::uint32_t> balls;
    for (std::size_t i = 0; i < count; ++i) balls.push_back(leaf(random_node<Sphere>(0, random_)));
    record(random_node<Kind>(count, random_), balls);
    return tree();
  }

  /// Node by node: the last one added is the root.
  std::uint32_t record(TreeNode node, const std::vector<std::uint32_t>& of) {
    nodes_->push_back(std::move(node));
    FieldTree::Record r;
    r.node = static_cast<std::uint32_t>(nodes_->size() - 1);
    r.first_child = static_cast<std::uint32_t>(children_.size());
    r.child_count = static_cast<std::uint32_t>(of.size());
    r.material = MaterialId{r.node};
    children_.insert(children_.end(), of.begin(), of.end());
    records_.push_back(r);
    return static_cast<std::uint32_t>(records_.size() - 1);
  }
  std::uint32_t leaf(TreeNode node) { return record(std::move(node), {}); }

  /// A random node over some levels of others.
  std::uint32_t add(int levels) {
    if (!records_.empty() && random_.between(0, 1) < 0.1)  // shared
      return static_cast<std::uint32_t>(random_.whole(0, static_cast<int>(records_.size()) - 1));
    for (;;) {
      const auto kind = static_cast<std::size_t>(random_.whole(0, static_cast<int>(kinds) - 1));
      if (const auto made = add_of(kind, levels, std::make_index_sequence<kinds>())) return *made;
    }
  }
  FieldTree tree() const { return FieldTree(nodes_, records_, children_); }

 private:
  template <std::size_t... I>
  std::optional<std::uint32_t> add_of(std::size_t kind, int levels, std::index_sequence<I...>) {
    std::optional<std::uint32_t> made;
    ((I == kind ? void(made = add_kind<std::variant_alternative_t<I, TreeNode::Kinds>>(levels)) : void()), ...);
    return made;
  }
  // Nothing when a leaf was asked for and it is none, or the other way round.
  template <class Kind>
  std::optional<std::uint32_t> add_kind(int levels) {
    if constexpr (std::same_as<Kind, BlendLeaf>) {
      if (levels > 0) return {};
      BlendField blend = random_blend(random_, random_.whole(3, 6), random_.between(0, 1.5), true, Projection::Exact);
      blend.distance_segments = {};
      return leaf(BlendLeaf{std::make_shared<const BlendField>(std::move(blend))});
    } else {
      constexpr NodeInfo info = info_of_kind<Kind>();
      if ((info.max_children == 0) != (levels == 0)) return {};
      const std::size_t most = std::min(info.max_children, info.min_children + 2);
      const auto count =
          static_cast<std::size_t>(random_.whole(static_cast<int>(info.min_children), static_cast<int>(most)));
      std::vector<std::uint32_t> of;
      for (std::size_t i = 0; i < count; ++i) of.push_back(add(random_.whole(0, levels - 1)));
      return record(random_node<Kind>(count, random_), of);
    }
  }

  static constexpr std::size_t kinds = std::variant_size_v<TreeNode::Kinds>;
  Random& random_;
  std::shared_ptr<std::vector<TreeNode>> nodes_;
  std::vector<FieldTree::Record> records_;
  std::vector<std::uint32_t> children_;
};

}  // namespace marrow::test
