// A tree of general nodes, ready for evaluation: the field of what is not one blend or a crisp union of blends.
//
// Nodes are records in one array, children before parents; a node may be the child of many. Nothing here recurses, so
// that depth costs memory only, and a part of space in which a node is 0 costs one test of a box.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "field/base/id.h"
#include "field/blend/material_weights.h"
#include "field/math/box3.h"
#include "field/number/functions.h"

namespace marrow {

/// What a record is; defined in tree_node.h.
struct TreeNode;
class LocalBlend;

class FieldTree {
 public:
  struct Record {
    std::uint32_t node = 0;  ///< index into nodes
    std::uint32_t first_child = 0, child_count = 0;
    MaterialId material;
    Box3 support;                                       ///< in the node's own coordinates; outside, the node is 0
    std::shared_ptr<const LocalBlend> local = nullptr;  ///< of a blend in a part of space; null: the blend as it is
  };

  /// `nodes` may be shared between trees. Preconditions: a crisp union is the first of them, which without children is
  /// 0 everywhere; children of a record stand before it; the last is the root.
  FieldTree(std::shared_ptr<const std::vector<TreeNode>> nodes, std::vector<Record> records,
            std::vector<std::uint32_t> children);
  FieldTree() = default;  ///< 0 everywhere
  static constexpr std::uint32_t index_of_union = 0;

  const TreeNode& node(const Record& r) const;
  std::span<const Record> records() const { return records_; }
  std::uint32_t root() const { return static_cast<std::uint32_t>(records_.size() - 1); }
  static constexpr std::uint32_t whole = 0xffffffff;  ///< stands for the root
  std::span<const std::uint32_t> children(const Record& r) const {
    return std::span(children_).subspan(r.first_child, r.child_count);
  }
  const std::shared_ptr<const std::vector<TreeNode>>& nodes() const { return nodes_; }

 private:
  std::shared_ptr<const std::vector<TreeNode>> nodes_;
  std::vector<Record> records_;
  std::vector<std::uint32_t> children_;
};

/// The field at p; 1 on the surface, larger inside. X: double, Jet<double, 3>, HessianJet, Interval,
/// Jet<Interval, 1>, Jet<Interval, 3>. Enclosures hold for every point of the box or ray piece that p spans.
/// With a record, of what stands below that alone, in its coordinates.
template <Number X>
X value(const FieldTree&, const Vec3<X>& p, std::uint32_t record = FieldTree::whole);

/// The same field inside a box, with less: nodes that are 0 there are gone, and so are operands that never count.
/// A tree without records is 0 all over the box.
FieldTree restricted(const FieldTree&, const Box3&, std::uint32_t record = FieldTree::whole);
/// The same, with bounds of the field in the box.
struct BoundedTree {
  FieldTree tree;
  Interval value;
};
BoundedTree restricted_and_bounded(const FieldTree&, const Box3&);
/// The same with blends summed as local_blend.h does, to within its certified error.
FieldTree localized(const FieldTree&, const Box3&, std::uint32_t record = FieldTree::whole);
/// Operands of operators that leave out those that do not count in a part of space.
std::size_t operands_that_may_go(const FieldTree&);
/// Whether anything of it lies below a warp other than a placement.
bool is_warped(const FieldTree&);
/// Whether sums over skeletons that are too near to be summed so take most of the time of any of its blends.
bool is_mostly_near(const FieldTree&);
/// Without its nodes.
std::size_t bytes_of(const FieldTree&);

/// Outside this box the field is below 1. Infinite where no bound is found.
Box3 surface_bounds(const FieldTree&);
/// The same for each child of the root, where that is a crisp union of several; else for the root alone.
struct UnionMember {
  std::uint32_t record;
  Box3 bounds;
  bool is_leaf;  ///< a primitive or a blend, at most placed
};
std::vector<UnionMember> members(const FieldTree&);

/// Primitives in the tree, those of blends among them; a shared node counts once.
std::size_t leaf_count(const FieldTree&);

/// Share of each contributing leaf in the value at p: w_i = f_i |dF/df_i|, normalised at every node, so that they sum
/// to 1. Empty where the field is 0.
struct LeafWeight {
  const FieldTree::Record* leaf;
  double weight;
  Vec3d local;  ///< p in the leaf's coordinates
};
std::vector<LeafWeight> leaf_weights(const FieldTree&, const Vec3d& p, std::uint32_t record = FieldTree::whole);

/// The weights of the leaves by material; that of a blend is shared out among its primitives.
MaterialWeights material_weights(const FieldTree&, const Vec3d& p, std::uint32_t record = FieldTree::whole);
/// That of all leaves, if they have the same; invalid: the object's own.
std::optional<MaterialId> only_material(const FieldTree&);
/// The material with the largest weight; invalid: the object's own.
MaterialId strongest_material(const FieldTree&, const Vec3d& p, std::uint32_t record = FieldTree::whole);

}  // namespace marrow
