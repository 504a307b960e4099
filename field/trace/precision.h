// How exact blocks are and how finely space is divided: the numbers that the tracer and its tests share.
#pragma once

#include <cstddef>

#include "field/trace/cell_tree.h"
#include "field/trace/near_far.h"

namespace marrow {

/// Of the coarse level, over the local radius: large enough to shorten its lists to a few sources, small enough to
/// bring the fine level close to the root at once.
inline constexpr double coarse_tolerance = 2e-2;

/// What one piece may contribute to a displacement of the surface by `tolerance` local radii.
/// The error of the corrected field is at most error(f) + error(G) / n (dC/df <= 1, dC/dG g'(C) <= 1 with g'(1) = n,
/// tracing.md 3.3), and the field falls by about n - 1 over one radius. A block has some 200 sources, most of whose
/// error bounds are far below their budget.
inline ErrorBudget budget_of(double tolerance, int degree) {
  const double share = tolerance * (degree - 1) / 400;
  return {.field = share, .gradient = share * degree};
}

/// Small cells have short lists, so rays are faster, but there are more of them to find and to keep. On the 867-segment
/// workload (3063 pieces) a sample takes 0.93 s of two threads at a half side of 0.5 radii, 0.83 s at 0.35 and 0.77 s
/// at 0.25, and the first one 0.25 s and 0.75 s more; with many pieces the number of cells matters more than their
/// lists.
inline CellTreeSettings cells_for(std::size_t piece_count) {
  return {.cell_size = piece_count < 5'000    ? 0.35
                       : piece_count < 20'000 ? 0.5
                                              : 0.8,
          .tile_levels = piece_count < 20'000 ? 1 : 2};
}

}  // namespace marrow
