#include "field/tree/set_expression.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "field/tree/tree_node.h"

namespace marrow {

FieldTree part_of_tree(const FieldTree& tree, std::span<const std::uint32_t> of, const Affine& world_from_tree) {
  const auto records = tree.records();
  std::vector<bool> wanted(records.size(), false);
  for (const std::uint32_t record : of) wanted[record] = true;
  for (std::size_t i = records.size(); i-- > 0;)
    if (wanted[i])
      for (const std::uint32_t child : tree.children(records[i])) wanted[child] = true;

  auto nodes = std::make_shared<std::vector<TreeNode>>();
  nodes->push_back(CrispUnion{});  // in front, as in every list of nodes
  std::vector<FieldTree::Record> made;
  std::vector<std::uint32_t> children, index(records.size());
  const auto append = [&](FieldTree::Record record, std::span<const std::uint32_t> below) {
    record.first_child = static_cast<std::uint32_t>(children.size());
    record.child_count = static_cast<std::uint32_t>(below.size());
    for (const std::uint32_t child : below) children.push_back(index[child]);
    made.push_back(std::move(record));
    return static_cast<std::uint32_t>(made.size() - 1);
  };
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!wanted[i]) continue;
    FieldTree::Record record = records[i];
    record.node = static_cast<std::uint32_t>(nodes->size());
    nodes->push_back(tree.node(records[i]));
    index[i] = append(std::move(record), tree.children(records[i]));
  }
  // The root is the last of all: the only one wanted, or what holds them.
  std::uint32_t root = index[of[0]];
  if (of.size() > 1) root = append({}, of);
  if (world_from_tree != Affine{}) {
    index.push_back(root);
    FieldTree::Record placed;
    placed.node = static_cast<std::uint32_t>(nodes->size());
    nodes->push_back(AffineWarp{world_from_tree, world_from_tree.inverse()});
    append(std::move(placed), std::array{static_cast<std::uint32_t>(index.size() - 1)});
  }
  return FieldTree(std::move(nodes), std::move(made), std::move(children));
}

// Reads a tree from the root down.
class SetExpression::Reader {
 public:
  Reader(const FieldTree& tree, const StandsAlone& stands_alone)
      : tree_(tree), stands_alone_(stands_alone), below_(tree.records().size()) {
    for (std::uint32_t i = 0; i < below_.size(); ++i) below_[i] = look_below(i);
  }

  // None where there is more than an expression is for.
  std::optional<SetExpression> read(std::uint32_t root) {
    if (!is_told_apart(root)) return {};
    made_ = {};
    entered_ = 0;
    too_large_ = false;
    const NodeIndex node = add(root, Affine{}, false);
    const auto is_blend = [](const Operand& operand) { return operand.blend != nullptr; };
    if (too_large_ || std::ranges::none_of(made_.operands_, is_blend)) return {};
    made_.root_ = node;
    made_.paths_.resize(made_.operands_.size());
    made_.find_paths(node, false, {});
    return std::move(made_);
  }

 private:
  // What stands below a record, counted on every way to it.
  struct Below {
    double records = 1, primitives = 0;
    double alone = 0;                // primitives of the largest blend that stands alone
    bool may_be_told_apart = false;  // such blends are operands, as far as it is known
  };

  Below look_below(std::uint32_t record) const {
    const TreeNode& node = tree_.node(tree_.records()[record]);
    Below below;
    if (const auto* blend = std::get_if<BlendLeaf>(&node)) {
      below.primitives = static_cast<double>(blend->field->size());
      below.may_be_told_apart = stands_alone_(*blend->field);
      below.alone = below.may_be_told_apart ? below.primitives : 0;
    } else if (children(record).empty()) {
      below.primitives = 1;
    }
    for (const std::uint32_t child : children(record)) {
      const Below& of = below_[child];
      below.records += of.records;
      below.primitives += of.primitives;
      below.alone = std::max(below.alone, of.alone);
      below.may_be_told_apart = below.may_be_told_apart || of.may_be_told_apart;
    }
    if (below.records > 2 * static_cast<double>(most_beside) ||
        below.primitives - below.alone > static_cast<double>(most_beside))
      below.may_be_told_apart = below.may_be_told_apart && (children(record).empty() || is_operation(node));
    return below;
  }

  // Another operator is where it lends its blend.
  bool is_told_apart(std::uint32_t record) {
    if (!below_[record].may_be_told_apart) return false;
    const bool is_lender = !children(record).empty() && !is_operation(tree_.node(tree_.records()[record]));
    return !is_lender || lends(record);
  }

  // Found out once, of some hundred records: each takes some thousand questions.
  bool lends(std::uint32_t record) {
    const auto [known, is_new] = lends_.try_emplace(record, false);
    if (!is_new) return known->second;
    asked_ += 1 + (below_[record].primitives - below_[record].alone) / 16;
    known->second =
        asked_ < most_asked && BlendInTree::of(part_of_tree(tree_, {{record}}, {}), stands_alone_) != nullptr;
    return known->second;
  }

  template <class... Kinds>
  static bool is_any_of(const TreeNode& node) {
    return (std::holds_alternative<Kinds>(node) || ...);
  }
  static bool is_union(const TreeNode& node) { return is_any_of<CrispUnion, SharpUnion>(node); }
  static bool is_difference(const TreeNode& node) { return is_any_of<Difference, SharpDifference>(node); }
  // Placements change nothing: operands are placed.
  static bool is_operation(const TreeNode& node) {
    return is_union(node) || is_difference(node) || is_any_of<Intersection, SharpIntersection, AffineWarp>(node);
  }

  NodeIndex add(std::uint32_t record, const Affine& world_from_parent, bool negated) {
    too_large_ = too_large_ || ++entered_ > most_nodes;
    if (too_large_) return 0;
    const TreeNode& node = tree_.node(tree_.records()[record]);
    if (const auto* warp = std::get_if<AffineWarp>(&node))
      return add(children(record)[0], world_from_parent * warp->parent_from_child, negated);
    if (const auto* blend = std::get_if<BlendLeaf>(&node))
      return append(Operand{blend->field, world_from_parent, {}, {}}, below_[record].primitives, negated);
    if (!is_operation(node)) return add_lender(record, world_from_parent, negated);
    Node made;
    made.negated = negated;
    const bool takes_away = is_difference(node);
    made.kind = is_union(node) ? Node::Kind::Union : Node::Kind::Intersection;
    if (takes_away) add_first(record, world_from_parent, made);
    add_children(children(record).subspan(takes_away ? 1 : 0), takes_away, world_from_parent, made);
    if (too_large_) return 0;  // of what is there by now nothing will be asked
    std::stable_sort(made.children.begin(), made.children.end(),
                     [&](NodeIndex a, NodeIndex b) { return made_.nodes_[a].cost < made_.nodes_[b].cost; });
    return append(std::move(made));
  }

  // The blend first, then all that holds it.
  NodeIndex add_lender(std::uint32_t record, const Affine& map, bool negated) {
    Operand whole{nullptr, {}, part_of_tree(tree_, {{record}}, map), {}};
    whole.lent = BlendInTree::of(whole.tree, stands_alone_);
    too_large_ = too_large_ || whole.lent == nullptr;  // as rounding has it
    if (too_large_) return 0;
    Node made;
    made.kind = Node::Kind::Lender;
    made.negated = negated;
    made.children.push_back(
        append(Operand{whole.lent->blend(), whole.lent->tree_from_blend(), {}, {}}, below_[record].alone, false));
    made.children.push_back(append(std::move(whole), below_[record].primitives, false));
    made.operand = made_.nodes_[made.children.back()].operand;
    return append(std::move(made));
  }

  void add_first(std::uint32_t difference, const Affine& map, Node& to) {
    const std::uint32_t first[] = {children(difference)[0]};
    add_children(first, false, map, to);
  }

  // Those without a blend that stands alone are one operand together, as far as they do the same.
  void add_children(std::span<const std::uint32_t> of, bool negated, const Affine& map, Node& to) {
    if (too_large_) return;
    std::vector<std::uint32_t> rest;
    for (const std::uint32_t child : of) {
      if (is_told_apart(child)) to.children.push_back(add(child, map, negated));
      else rest.push_back(child);
    }
    // Taken away is what is in any of them.
    const bool as_one = negated || to.kind == Node::Kind::Union;
    if (rest.empty()) return;
    if (as_one) return void(to.children.push_back(add_rest(rest, map, negated)));
    for (const std::uint32_t record : rest) to.children.push_back(add_rest(std::span(&record, 1), map, negated));
  }

  NodeIndex add_rest(std::span<const std::uint32_t> records, const Affine& map, bool negated) {
    double primitives = 0;
    for (const std::uint32_t record : records) primitives += below_[record].primitives;
    too_large_ = too_large_ || primitives > static_cast<double>(most_beside);
    if (too_large_) return 0;
    return append(Operand{nullptr, {}, part_of_tree(tree_, records, map), {}}, primitives, negated);
  }

  NodeIndex append(Operand operand, double cost, bool negated) {
    Node node;
    node.negated = negated;
    node.operand = static_cast<std::uint32_t>(made_.operands_.size());
    node.cost = cost;
    made_.operands_.push_back(std::move(operand));
    return append(std::move(node));
  }
  NodeIndex append(Node node) {
    for (const NodeIndex child : node.children) node.cost += made_.nodes_[child].cost;
    made_.nodes_.push_back(std::move(node));
    too_large_ = too_large_ || made_.nodes_.size() > most_nodes;
    return static_cast<NodeIndex>(made_.nodes_.size() - 1);
  }

  std::span<const std::uint32_t> children(std::uint32_t record) const {
    return tree_.children(tree_.records()[record]);
  }

  const FieldTree& tree_;
  const StandsAlone& stands_alone_;
  std::vector<Below> below_;  // of records
  std::map<std::uint32_t, bool> lends_;
  static constexpr double most_asked = 256;
  double asked_ = 0;
  SetExpression made_;
  std::size_t entered_ = 0;  // records, so that no chain of them is followed too far
  bool too_large_ = false;
};

std::vector<std::optional<SetExpression>> SetExpression::of(const FieldTree& tree,
                                                            std::span<const std::uint32_t> records,
                                                            const StandsAlone& stands_alone) {
  Reader reader(tree, stands_alone);
  std::vector<std::optional<SetExpression>> made;
  for (const std::uint32_t record : records) made.push_back(reader.read(record));
  return made;
}

std::optional<SetExpression> SetExpression::of(const FieldTree& tree, std::uint32_t record,
                                               const StandsAlone& stands_alone) {
  return std::move(of(tree, std::span(&record, 1), stands_alone).front());
}

void SetExpression::find_paths(NodeIndex index, bool is_taken_away, const std::vector<Condition>& above) {
  const Node& node = nodes_[index];
  is_taken_away = is_taken_away != node.negated;
  if (node.kind == Node::Kind::Operand) {
    const auto cost = [&](const Condition& c) { return c.wanted == Side::Unknown ? 0 : nodes_[c.node].cost; };
    paths_[node.operand] = {is_taken_away, !above.empty() && above.back().wanted == Side::Unknown, above};
    std::ranges::stable_sort(paths_[node.operand].conditions, {}, cost);
    return;
  }
  if (node.kind == Node::Kind::Lender) {
    std::vector<Condition> decides = above;
    decides.push_back({index, Side::Unknown});
    find_paths(node.children[0], is_taken_away, decides);
    find_paths(node.children[1], is_taken_away, above);
    return;
  }
  // What is in a union is so whatever the others say, unless they are all outside.
  const Side idle = node.kind == Node::Kind::Union ? Side::Outside : Side::Inside;
  for (const NodeIndex child : node.children) {
    std::vector<Condition> conditions = above;
    for (const NodeIndex other : node.children)
      if (other != child) conditions.push_back({other, idle});
    find_paths(child, is_taken_away, conditions);
  }
}

}  // namespace marrow
