// The two levels of a block, from the sources around it.
#pragma once

#include <vector>

#include "field/trace/block.h"
#include "field/trace/level_layout.h"
#include "field/trace/source_emitter.h"

namespace marrow {

/// `rules`, when not null: grow by those that made the sources.
/// Its errors count wherever "outside" is to be proved.
BlockLevel coarse_level(const Block::Context&, const CellTree::Cell&, const Allocate&,
                        std::vector<PieceRule>* rules = nullptr);
/// Its errors are only stated: it is the field that is traced.
BlockLevel fine_level(const Block::Context&, const CellTree::Cell&, const Allocate&,
                      std::vector<PieceRule>* rules = nullptr);

}  // namespace marrow
