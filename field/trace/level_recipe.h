// How the sources of a level were made: a ninth of their size, and no search of the tree when they are made again.
#pragma once

#include <cstdint>
#include <span>

#include "field/trace/block.h"
#include "field/trace/level_layout.h"
#include "field/trace/source_emitter.h"

namespace marrow {

/// Of a level without angles of its own. What is made from it has the bits of the level.
struct LevelRecipe {
  std::span<const PieceRule> rules;  ///< in the order of the sources
  BlockLevel level;                  ///< without sources
};

/// Whether the levels of such blocks can be told by recipes.
inline bool have_recipes(const Block::Context& context) { return context.angle == nullptr; }

LevelRecipe recipe_of(const BlockLevel&, std::span<const PieceRule>, const Allocate&);
BlockLevel level_from(const LevelRecipe&, const Block::Context&, const CellTree::Cell&, const Allocate&);
/// The same level in other memory.
BlockLevel copy_of(const BlockLevel&, const Allocate&);

}  // namespace marrow
