// Children before parents: one pass over the nodes that are below the roots, after two that find what to merge.
#include "field/program/tree_builder.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "field/base/overloaded.h"
#include "field/program/simplify.h"

namespace marrow {
namespace {

// The children of a node that stand in the tree; a blend is a leaf.
std::span<const FieldNodeId> children_of(const FieldNode& node) {
  return std::visit(Overloaded{[](const Primitive&) { return std::span<const FieldNodeId>(); },
                               [](const Blend&) { return std::span<const FieldNodeId>(); },
                               [](const Transform& t) { return std::span(&t.of, 1); },
                               [](const auto& n) { return std::span<const FieldNodeId>(n.of); }},
                    node.what);
}

TreeNode point_leaf(const PointSkeleton& p) { return PointLeaf{p.at, p.radius}; }

}  // namespace

TreeBuilder::TreeBuilder(const FieldDescription& description, LeafOf leaf_of)
    : description_(description), leaf_of_(std::move(leaf_of)), nodes_(std::make_shared<std::vector<TreeNode>>()) {
  nodes_->push_back(CrispUnion{});
}

void TreeBuilder::read(std::span<const FieldNodeId> roots) {
  const std::vector<std::size_t> below = nodes_below(roots);
  if (below.empty()) return;
  const std::size_t count = below.back() + 1;
  places_.resize(count);
  absorbed_.assign(count, false);
  left_out_.assign(count, false);
  operands_.resize(count);
  find_absorbed(below, roots);
  find_sums_of_points(below);
  for (const std::size_t i : below) add(i);
}

std::vector<std::size_t> TreeBuilder::nodes_below(std::span<const FieldNodeId> roots) const {
  std::vector<bool> seen(description_.nodes.size(), false);
  std::vector<std::size_t> open, indices;
  const auto enter = [&](std::span<const FieldNodeId> children) {
    for (const FieldNodeId child : children) {
      if (seen[child.index()]) continue;
      seen[child.index()] = true;
      open.push_back(child.index());
    }
  };
  for (enter(roots); !open.empty();) {
    indices.push_back(open.back());
    open.pop_back();
    enter(children_of(description_.nodes[indices.back()]));
  }
  std::sort(indices.begin(), indices.end());
  return indices;
}

// A node that one parent alone uses may become part of it.
void TreeBuilder::find_absorbed(const std::vector<std::size_t>& below, std::span<const FieldNodeId> roots) {
  std::vector<std::uint32_t> uses(places_.size(), 0);
  for (const FieldNodeId root : roots) uses[root.index()] += 2;
  for (const std::size_t i : below)
    for (const FieldNodeId child : children_of(description_.nodes[i])) ++uses[child.index()];
  for (const std::size_t i : below) {
    const FieldNode& node = description_.nodes[i];
    bool is_first = true;
    for (const FieldNodeId child : children_of(node)) {
      const Absorbs how = uses[child.index()] == 1 ? absorbs(node, description_[child]) : Absorbs::Nothing;
      absorbed_[child.index()] = how == Absorbs::Anywhere || (how == Absorbs::First && is_first);
      is_first = false;
    }
  }
}

// From the top, so that each is looked through once.
void TreeBuilder::find_sums_of_points(const std::vector<std::size_t>& below) {
  for (auto i = below.rbegin(); i != below.rend(); ++i) {
    const bool is_inner = absorbed_[*i] || left_out_[*i];
    if (const auto blend = is_inner ? std::nullopt : sum_of_points(description_, FieldNodeId{*i})) {
      places_[*i].record = append(leaf_of_(*blend, FieldNodeId{*i}), {}, {});
      left_out_[*i] = true;
    }
    // what only such a sum uses is not needed
    if (!left_out_[*i]) continue;
    for (const FieldNodeId child : children_of(description_.nodes[*i]))
      if (absorbed_[child.index()]) left_out_[child.index()] = true;
  }
}

void TreeBuilder::add(std::size_t i) {
  if (left_out_[i]) return;
  const FieldNodeId id{i};
  std::visit(
      Overloaded{
          [&](const Union& u) { add_operation(i, CrispUnion{}, u.of, {}); },
          [&](const Transform& t) {
            const Place& of = places_[t.of.index()];
            places_[i] = {of.record == none ? record_of(t.of) : of.record, static_cast<std::uint32_t>(maps_.size())};
            maps_.push_back(t.parent_from_child * maps_[of.map]);
          },
          [&](const Blend& b) { places_[i].record = append(leaf_of_(b, id), {}, {}); },
          [](const Primitive&) {},  // made when a parent asks, since a sum of points has no use for it
          [&](const GeneralNode& n) {
            add_operation(i, std::visit([](const auto& kind) { return TreeNode(kind); }, n.node->node), n.of,
                          n.material);
          }},
      description_.nodes[i].what);
}

void TreeBuilder::add_operation(std::size_t i, TreeNode kind, const std::vector<FieldNodeId>& of, MaterialId material) {
  std::vector<std::uint32_t> all = operands(of);
  if (absorbed_[i]) operands_[i] = std::move(all);
  else places_[i].record = append(std::move(kind), all, material);
}

// The longest list is taken over as it is, so that a chain costs its length only; what folds from the left has none but
// the first.
std::vector<std::uint32_t> TreeBuilder::operands(const std::vector<FieldNodeId>& of) {
  if (of.empty()) return {};
  const auto length = [&](FieldNodeId id) { return absorbed_[id.index()] ? operands_[id.index()].size() : 0; };
  const FieldNodeId longest =
      *std::max_element(of.begin(), of.end(), [&](FieldNodeId a, FieldNodeId b) { return length(a) < length(b); });
  std::vector<std::uint32_t> all;
  if (absorbed_[longest.index()]) all = std::exchange(operands_[longest.index()], {});
  for (const FieldNodeId child : of) {
    if (!absorbed_[child.index()]) {
      all.push_back(record_of(child));
    } else if (child != longest) {
      const std::vector<std::uint32_t> more = std::exchange(operands_[child.index()], {});
      all.insert(all.end(), more.begin(), more.end());
    }
  }
  return all;
}

// With its placement.
std::uint32_t TreeBuilder::record_of(FieldNodeId id) {
  Place& place = places_[id.index()];
  if (place.record == none) {  // of a primitive, which was put off
    const auto& primitive = std::get<Primitive>(description_[id].what);
    const PointSkeleton* point = lone_point(description_[id]);
    place.record =
        append(point != nullptr ? point_leaf(*point) : leaf_of_(blend_of_one(id), id), {}, primitive.material);
  }
  if (place.map != 0) place = {placed(place.record, maps_[place.map]), 0};
  return place.record;
}

std::uint32_t TreeBuilder::placed(std::uint32_t record, const Affine& map) {
  if (map == Affine{}) return record;
  const std::uint32_t of[] = {record};
  return append(AffineWarp{map, map.inverse()}, of, {});
}

std::uint32_t TreeBuilder::append(TreeNode node, std::span<const std::uint32_t> children, MaterialId material) {
  records_.push_back({.node = static_cast<std::uint32_t>(nodes_->size()),
                      .first_child = static_cast<std::uint32_t>(children_.size()),
                      .child_count = static_cast<std::uint32_t>(children.size()),
                      .material = material,
                      .support = {}});
  nodes_->push_back(std::move(node));
  double visits = 1;
  for (const std::uint32_t child : children) {
    children_.push_back(child);
    visits += visits_below_[child];
  }
  visits_below_.push_back(visits);
  return static_cast<std::uint32_t>(records_.size() - 1);
}

void TreeBuilder::place(FieldNodeId root, const Affine& world_from_node) {
  const Place& there = places_[root.index()];
  const std::uint32_t record = there.map == 0 ? record_of(root) : there.record;
  roots_.push_back(placed(record, there.map == 0 ? world_from_node : world_from_node * maps_[there.map]));
  visits_ = std::max(visits_, visits_below_[roots_.back()]);
}

void TreeBuilder::place(TreeNode leaf, const Affine& world_from_leaf, MaterialId material) {
  roots_.push_back(placed(append(std::move(leaf), {}, material), world_from_leaf));
  visits_ = std::max(visits_, visits_below_[roots_.back()]);
}

// The root is the last record. It may stand before, as the one that was placed, with what nothing else needs behind.
FieldTree TreeBuilder::tree() && {
  if (roots_.size() != 1) append(CrispUnion{}, roots_, {});
  else records_.resize(roots_[0] + 1);
  return FieldTree(std::move(nodes_), std::move(records_), std::move(children_));
}

}  // namespace marrow
