// The two levels of a block, from the sources around it.
#pragma once

#include "field/trace/block.h"
#include "field/trace/level_layout.h"

namespace marrow {

/// Its errors count wherever "outside" is to be proved.
BlockLevel coarse_level(const Block::Context&, const CellTree::Cell&, const Allocate&);
/// Its errors are only stated: it is the field that is traced.
BlockLevel fine_level(const Block::Context&, const CellTree::Cell&, const Allocate&);

}  // namespace marrow
