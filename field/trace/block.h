// What tracing needs of one cell: near sources, the far field, and polynomials that tell where surface can be.
#pragma once

#include <span>

#include "field/trace/block_arena.h"
#include "field/trace/block_kernels.h"
#include "field/trace/cell_tree.h"
#include "field/trace/patches.h"

namespace marrow {

/// Immutable once built. Coordinates of the block: x = (p - center) / half.
class Block {
 public:
  struct Context {
    std::span<const Piece> pieces;  ///< in the order of the source tree
    const CellTree& tree;
    const PieceCutter& cutter;
    const NearFar& coarse;  ///< errors of the sources that polynomials are made from
    const NearFar& fine;    ///< errors of the fine level, and of the tree's far fields
    const LatticeErrors& lattice;
    const IsoCurve& iso;
    const BlockKernels& kernels;
    int degree;
  };
  /// The sources live in the arena.
  Block(const Context&, const CellTree::Cell&, BlockArena&);

  const BlockView& view() const { return view_; }
  const Vec3d& center() const { return center_; }
  double half() const { return half_; }
  /// Certified bounds of the difference between the fine level and the exact field, over the cell.
  double f_error() const { return f_error_; }
  double gradient_error() const { return gradient_error_; }

 private:
  Vec3d center_;
  double half_;
  double f_error_ = 0, gradient_error_ = 0;
  BlockView view_;
};

}  // namespace marrow
