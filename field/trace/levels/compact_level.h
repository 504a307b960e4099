// What a level is made of: pieces and how many nodes stand for them, a third of the size of the nodes themselves.
#pragma once

#include <span>
#include <vector>

#include "field/trace/kernels/block_kernels.h"
#include "field/trace/levels/block_level.h"
#include "field/trace/levels/level_layout.h"

namespace marrow {

/// What a level without angles of its own is made of, gathered.
struct CompactParts {
  std::vector<CurvePiece> curves;
  SourceGroups points;
  LevelPolynomials far;  ///< with the errors of the level
};

/// The same in one piece of memory, at whose beginning this stands; 64-byte aligned, freed with that memory.
struct CompactLevel {
  BlockLevel level;  ///< all but the sources of curves
  std::span<const CurvePiece> curves;
  std::size_t lines = 0;  ///< of memory, of 64 bytes
};

/// Errors count as the level is told later: those of its FieldLevel are left at 0.
CompactLevel& write_compact(const CompactParts&, const Allocate&);
/// The same in other memory.
const CompactLevel& copy_of(const CompactLevel&, const Allocate&);
/// The level with all its sources, in memory of its own.
BlockLevel expanded(const CompactLevel&, const BlockKernels&, const Allocate&);

}  // namespace marrow
