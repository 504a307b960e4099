#include "field/tree/field_tree.h"

#include <algorithm>
#include <concepts>
#include <iterator>
#include <utility>

#include "field/blend/bounds/blend_bounds.h"
#include "field/number/places_in.h"
#include "field/tree/machine.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;
constexpr Box3 all_space{{-inf, -inf, -inf}, {inf, inf, inf}};

// The box that an operator can be above `level` in, from the boxes of its children.
Box3 reach_of(const TreeNode& node, std::span<const Box3> children, double level) {
  return std::visit(
      [&]<class Node>(const Node& n) -> Box3 {
        if constexpr (std::same_as<Node, BlendLeaf>) return blend_extent(*n.field, level);
        else if constexpr (requires { n.extent(level); }) return level > 0 ? n.extent(level) : n.support();
        else if constexpr (requires { n.support(); }) return n.support();
        else if constexpr (requires { n.support(children[0]); }) return n.support(children[0]);
        else if constexpr (requires { n.support(children); }) return n.support(children);
        else {
          Box3 hull;
          for (const Box3& b : children) hull.include(b);
          return hull;
        }
      },
      node);
}

double level_of_children(const TreeNode& node, double level, std::size_t count) {
  return std::visit(
      [&]<class Node>(const Node& n) {
        if constexpr (requires { n.child_level(level, count); }) return n.child_level(level, count);
        else return level;
      },
      node);
}

}  // namespace

Box3 AffineWarp::support(const Box3& child) const {
  if (child.empty()) return child;
  Box3 box;
  for (const Vec3d& c : corners_of(child)) {
    if (!is_finite(c)) return all_space;
    box.include(parent_from_child.point(c));
  }
  return box.padded(1e-14 * (largest_coordinate(box) + length(parent_from_child.translation)));
}

FieldTree::FieldTree(std::shared_ptr<const std::vector<TreeNode>> nodes, std::vector<Record> records,
                     std::vector<std::uint32_t> children)
    : nodes_(std::move(nodes)), records_(std::move(records)), children_(std::move(children)) {
  std::vector<Box3> boxes;
  for (Record& r : records_) {
    if (r.child_count == 0 && !r.support.empty()) continue;  // of a leaf of another tree: blends are long to go through
    boxes.clear();
    for (const std::uint32_t c : this->children(r)) boxes.push_back(records_[c].support);
    r.support = reach_of(node(r), boxes, 0);
  }
}

const TreeNode& FieldTree::node(const Record& r) const { return (*nodes_)[r.node]; }

std::size_t leaf_count(const FieldTree& tree) {
  std::size_t count = 0;
  for (const FieldTree::Record& r : tree.records()) {
    if (r.child_count > 0) continue;
    const auto* blend = std::get_if<BlendLeaf>(&tree.node(r));
    count += blend != nullptr ? blend->field->size() : 1;
  }
  return count;
}

namespace {

// From the root down each node learns the level that its parents care about, the least of several; then boxes go up.
std::vector<Box3> reaches(const FieldTree& tree) {
  const auto records = tree.records();
  std::vector<double> level(records.size(), inf);
  level.back() = 1;
  for (std::size_t i = records.size(); i-- > 0;) {
    const auto children = tree.children(records[i]);
    const double wanted = level_of_children(tree.node(records[i]), level[i], children.size());
    for (const std::uint32_t c : children) level[c] = std::min(level[c], wanted);
  }
  std::vector<Box3> reach(records.size()), boxes;
  for (std::size_t i = 0; i < records.size(); ++i) {
    boxes.clear();
    for (const std::uint32_t c : tree.children(records[i])) boxes.push_back(reach[c]);
    reach[i] = reach_of(tree.node(records[i]), boxes, level[i]);
  }
  return reach;
}

}  // namespace

Box3 surface_bounds(const FieldTree& tree) { return tree.records().empty() ? Box3{} : reaches(tree).back(); }

std::vector<UnionMember> members(const FieldTree& tree) {
  const auto records = tree.records();
  if (records.empty()) return {};
  const std::vector<Box3> reach = reaches(tree);
  const auto is_leaf = [&](std::uint32_t i) {
    while (std::holds_alternative<AffineWarp>(tree.node(records[i]))) i = tree.children(records[i])[0];
    return records[i].child_count == 0;
  };
  const FieldTree::Record& root = records.back();
  if (!std::holds_alternative<CrispUnion>(tree.node(root))) return {{tree.root(), reach.back(), is_leaf(tree.root())}};
  std::vector<UnionMember> all;
  for (const std::uint32_t c : tree.children(root)) all.push_back({c, reach[c], is_leaf(c)});
  return all;
}

bool is_warped(const FieldTree& tree) {
  return std::any_of(tree.records().begin(), tree.records().end(), [&](const FieldTree::Record& r) {
    const TreeNode& node = tree.node(r);
    return tree::is_warp(node) && !std::holds_alternative<AffineWarp>(node);
  });
}

bool is_mostly_near(const FieldTree& tree) {
  return std::any_of(tree.records().begin(), tree.records().end(),
                     [](const FieldTree::Record& r) { return r.local && r.local->is_mostly_near(); });
}

std::size_t bytes_of(const FieldTree& tree) {
  double bytes = static_cast<double>(sizeof tree + tree.records().size() * sizeof(FieldTree::Record));
  for (const FieldTree::Record& r : tree.records()) {
    bytes += static_cast<double>(r.child_count * sizeof(std::uint32_t));
    if (r.local) bytes += static_cast<double>(r.local->bytes()) / static_cast<double>(r.local.use_count());
  }
  return static_cast<std::size_t>(bytes);
}

}  // namespace marrow
