// What tracing needs of one cell: near sources, the far field, and polynomials that tell where surface can be.
#pragma once

#include <optional>
#include <span>

#include "field/math/box3.h"
#include "field/trace/block_arena.h"
#include "field/trace/block_kernels.h"
#include "field/trace/cell_tree.h"
#include "field/trace/lazy.h"
#include "field/trace/patches.h"

namespace marrow {

/// Coordinates of the block: x = (p - center) / half. The sources with which roots are decided are gathered when the
/// first ray needs them; safe to use from many threads.
class Block {
 public:
  struct Context {
    std::span<const Piece> pieces;  ///< in the order of the source tree
    const CellTree& tree;
    const PieceCutter& cutter;
    const NearFar& coarse;             ///< errors of the sources that polynomials are made from
    const NearFar& fine;               ///< errors of the fine level
    const LatticeError (&lattice)[2];  ///< of curves, and of points
    const IsoCurve& iso;
    const BlockKernels& kernels;
    int degree;
    BlockArena& arena;  ///< holds what blocks are made of
    bool polynomials;   ///< see PatchSource
  };
  /// The context must outlive the block.
  Block(const Context&, const CellTree::Cell&);
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  const BlockView& view() const { return view_; }
  const Vec3d& center() const { return cell_.center; }
  double half() const { return cell_.half; }
  /// Around all surface in the cell; empty when there is none.
  const Box3& box() const { return box_; }

  /// What is rendered, and certified bounds of its difference from the exact field, over the cell.
  struct Fine {
    FieldLevel level;
    double f_error = 0, gradient_error = 0;
  };
  const Fine& fine() const;
  const Fine* fine_if_made() const { return fine_.peek(); }

 private:
  const Context& context_;
  CellTree::Cell cell_;
  Box3 box_;
  FieldLevel coarse_;
  PatchSource source_;
  std::optional<OctantPatches> octants_;
  BlockView view_;
  Lazy<Fine> fine_;
};

}  // namespace marrow
