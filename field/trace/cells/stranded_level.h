// What the patches of a block are made from, where directions of strands give its angle (share_patches.h).
#pragma once

#include <vector>

#include "field/trace/cells/block.h"
#include "field/trace/cells/strands.h"
#include "field/trace/levels/level_layout.h"

namespace marrow {

/// The near pieces of the strands that a cell counts one by one, each strand with groups of its own; and points.
struct StrandedLevel {
  SourceGroups curves, points;
  CellStrands seen;
  std::vector<int> groups;        ///< of each strand of `seen`
  std::vector<float> directions;  ///< as StrandLevel::directions
  bool have_own_angles = false;   ///< then, as StrandLevel says:
  std::vector<StrandAngle> angles;
  std::vector<float> point_crossing;
};

/// Precondition: the context has strands.
StrandedLevel make_stranded_level(const Block::Context&, const CellTree::Cell&);

/// Without far polynomials: of its level kernels find shares alone.
BlockLevel write_stranded_level(const StrandedLevel&, const Allocate&);
/// The shares at strand_place of a cube in the coordinates of the block, by such a level; or, where that is weak, by
/// the blend itself. Returns what they may be off.
double find_shares(const Block::Context&, const CellTree::Cell&, const BlockLevel&, const float (&center)[3],
                   float half, StrandShares&);

}  // namespace marrow
