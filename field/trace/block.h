// What tracing needs of one cell: near sources, the far field, and which of its sub-cells may hold surface.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "field/trace/block_kernels.h"
#include "field/trace/cell_tree.h"

namespace marrow {

/// Immutable once built. Coordinates of the block: x = (p - center) / half.
class Block {
 public:
  struct Context {
    std::span<const Piece> pieces;
    const CellTree& tree;
    const PieceCutter& cutter;
    const NearFar& coarse;  ///< errors of the coarse level
    const NearFar& fine;    ///< errors of the fine level, and of the tree's far fields
    const IsoCurve& iso;
    const BlockKernels& kernels;
    int degree;
  };
  Block(const Context&, const CellTree::Cell&);

  const BlockView& view() const { return view_; }
  std::uint64_t mask() const { return mask_; }
  const Vec3d& center() const { return center_; }
  double half() const { return half_; }
  /// Certified bounds of the difference between the fine level and the exact field, over the cell.
  double f_error() const { return f_error_; }
  double gradient_error() const { return gradient_error_; }
  std::size_t bytes() const;

 private:
  struct AlignedDelete {
    void operator()(float*) const;
  };
  Vec3d center_;
  double half_;
  double f_error_ = 0, gradient_error_ = 0;
  std::uint64_t mask_ = 0;
  std::size_t float_count_ = 0;
  std::unique_ptr<float[], AlignedDelete> floats_;
  BlockView view_;
};

}  // namespace marrow
