// The two levels of a block, from the sources around it.
#pragma once

#include "field/trace/cells/block.h"
#include "field/trace/levels/compact_level.h"
#include "field/trace/levels/level_layout.h"

namespace marrow {

/// The coarse level, whose errors count wherever "outside" is to be proved; and the fine one, whose errors are only
/// stated: it is the field that is traced.
enum class LevelKind { Coarse, Fine };

/// Where skeletons have no angle each.
const CompactLevel& compact_level(LevelKind, const Block::Context&, const CellTree::Cell&, const Allocate&);
/// With the field of angles.
BlockLevel level_with_angles(LevelKind, const Block::Context&, const CellTree::Cell&, const Allocate&);

}  // namespace marrow
