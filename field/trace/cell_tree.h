// Space divided into cubes that may hold surface of one blend.
//
// An octree from the region of influence down to cells of about the local radius. A cube is dropped when bounds of
// f and |grad_S f| prove the corrected field below 1 (or above 1) all over it. Each branch keeps the pieces near it
// and a far field of all others, inherited and refined from its parent, so that a cell's lists are short.
#pragma once

#include <cstdint>
#include <vector>

#include "field/math/box3.h"
#include "field/trace/block_kernels.h"
#include "field/trace/iso_curve.h"
#include "field/trace/near_far.h"
#include "field/trace/pieces.h"

namespace marrow {

struct CellTreeSettings {
  double cell_size = 0.5;  ///< half side of a cell over the local radius, at most
  int deepest_level = 40;
};

class CellTree {
 public:
  struct Branch {
    Vec3d center;
    double half = 0;
    std::vector<PieceIndex> near;
    FarField far;
  };
  /// One of the eight half-sized cubes of a branch. Its planes are exactly those of its neighbours.
  struct Cell {
    Vec3d center;
    double half;
    std::uint32_t branch;
    std::uint8_t octant;

    Box3 box() const {
      const Vec3d h{half, half, half};
      return {center - h, center + h};
    }
  };

  CellTree(std::span<const Piece>, const NearFar&, const IsoCurve&, const BlockKernels&, int degree,
           const CellTreeSettings&);

  std::span<const Cell> cells() const { return cells_; }
  const Branch& branch(const Cell& c) const { return branches_[c.branch]; }
  std::size_t bytes() const;

 private:
  std::vector<Branch> branches_;  // those with cells
  std::vector<Cell> cells_;
};

Vec3d octant_center(const Vec3d& center, double half, int octant);

}  // namespace marrow
