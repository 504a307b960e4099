// Cubes of space with what a tree of nodes is in them, divided when rays come.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "field/base/lazy.h"
#include "field/math/ray.h"
#include "field/number/interval.h"
#include "field/trace/cells/ray_spacing.h"
#include "field/tree/blend_in_tree.h"
#include "field/tree/field_tree.h"

namespace marrow {

/// The part of a ray with t >= ray.t_min in a box and a little beyond; neighbours overlap, so that no root falls
/// between them by rounding. Empty: lo > hi.
Interval clip(const Box3&, const Ray&);

/// What tells, beside the tree, how far space is divided. It must outlive the cells.
struct TreeDivision {
  /// A blend of the tree that is traced by itself, so that no part is made where it decides; null: none.
  std::shared_ptr<const BlendInTree> lent;
  /// Of the rays of a camera, in the tree's coordinates; null: not known.
  std::shared_ptr<const RaySpacing> spacing;
};

/// A cube that may hold surface. What it holds is a function of its place alone. Safe to use from many threads.
class TreeCell {
 public:
  /// All of a box with the field of a tree, or of what stands below a record of it.
  static std::unique_ptr<const TreeCell> root(const FieldTree&, const Box3&, std::uint32_t record, const TreeDivision&);

  Box3 box() const { return Box3{center_, center_}.padded(half_); }
  /// Equal to the whole in the box and a little beyond.
  const FieldTree& tree() const { return *tree_; }
  /// Whether p is where tree() holds.
  bool holds(const Vec3d& p) const;
  /// Fine enough to be searched as it is.
  bool is_leaf() const { return is_leaf_; }
  int level() const { return level_; }

  static constexpr std::size_t octant_count = 8;
  /// One of them, made when it is first asked for; null where bounds prove all of it outside or inside, or
  /// a blend decides that is traced by itself.
  const TreeCell* octant(std::size_t i) const;
  Box3 octant_box(std::size_t i) const;

  /// The leaf around p, or, where p lies in none, the smallest cell.
  const TreeCell& leaf_at(const Vec3d& p) const;

  /// Of what has been made so far.
  std::size_t bytes() const;

 private:
  TreeCell(const Vec3d& center, double half, int level, const TreeDivision& division)
      : center_(center), half_(half), level_(level), division_(division) {}
  std::unique_ptr<const TreeCell> make_octant(std::size_t i) const;

  Vec3d center_;
  double half_;
  int level_;
  bool is_leaf_ = false;
  const TreeDivision& division_;
  std::shared_ptr<const FieldTree> tree_;  ///< may serve several cells
  using Octant = std::unique_ptr<const TreeCell>;
  std::array<Lazy<Octant>, octant_count> octants_;
};

}  // namespace marrow
