// What the patches of a block are made from, where directions of strands give its angle (share_patch.h).
#pragma once

#include <vector>

#include "field/trace/block.h"
#include "field/trace/level_layout.h"
#include "field/trace/strands.h"

namespace marrow {

/// The near pieces strand by strand, each with groups of its own; then what has been counted among the far strands.
struct StrandedLevel {
  Level level;
  CellStrands seen;
  std::vector<int> groups;        // of each strand of `seen`
  std::vector<float> directions;  // as StrandLevel::directions
  int lanes_told = 0;             // of the curves
};

StrandedLevel make_stranded_level(const Block::Context&, const CellTree::Cell&);

BlockLevel write_stranded_level(const StrandedLevel&, const Allocate&);

}  // namespace marrow
