// From the nodes of a description to the records of one tree; internal to program/.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "field/description/field_node.h"
#include "field/math/affine.h"
#include "field/tree/field_tree.h"
#include "field/tree/tree_node.h"

namespace marrow {

/// Each node is held once, however often it is placed. Chains of placements become one placement, chains of one
/// operation one wide node (simplify.h): depth costs neither evaluation nor a copy in each part of space.
class TreeBuilder {
 public:
  /// What makes a leaf of a blend, or of a primitive alone, in the coordinates of that node.
  using LeafOf = std::function<TreeNode(const Blend&, FieldNodeId)>;
  TreeBuilder(const FieldDescription&, LeafOf);

  /// All that stands below these nodes, without what stands inside blends. Before place().
  void read(std::span<const FieldNodeId> roots);

  /// A field that the tree is the union of.
  void place(FieldNodeId root, const Affine& world_from_node);
  void place(TreeNode leaf, const Affine& world_from_leaf, MaterialId material);

  /// How many nodes a walk through one of the placed fields visits, the most of any.
  double visits() const { return visits_; }
  FieldTree tree() &&;

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  // What a node of the description has become: a record, and the placement that is still to be put above it, by its
  // index; 0: none.
  struct Place {
    std::uint32_t record = none, map = 0;
  };

  std::vector<std::size_t> nodes_below(std::span<const FieldNodeId> roots) const;
  void find_absorbed(const std::vector<std::size_t>& below, std::span<const FieldNodeId> roots);
  void find_sums_of_points(const std::vector<std::size_t>& below);
  void add(std::size_t node);
  void add_operation(std::size_t node, TreeNode kind, const std::vector<FieldNodeId>& of, MaterialId material);
  std::vector<std::uint32_t> operands(const std::vector<FieldNodeId>& of);
  std::uint32_t record_of(FieldNodeId);
  std::uint32_t placed(std::uint32_t record, const Affine&);
  std::uint32_t append(TreeNode, std::span<const std::uint32_t> children, MaterialId material);

  const FieldDescription& description_;
  LeafOf leaf_of_;
  std::vector<Place> places_;
  std::vector<Affine> maps_{Affine{}};
  std::vector<char> absorbed_, left_out_;
  std::vector<std::vector<std::uint32_t>> operands_;  // of absorbed nodes, until their parent takes them
  std::vector<double> visits_below_;                  // by record
  double visits_ = 0;

  std::shared_ptr<std::vector<TreeNode>> nodes_;
  std::vector<FieldTree::Record> records_;
  std::vector<std::uint32_t> children_, roots_;
};

}  // namespace marrow
