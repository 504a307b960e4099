// How exact blocks are and how finely space is divided: the numbers that the tracer and its tests share.
#pragma once

#include <cstddef>

#include "field/trace/cells/cell_settings.h"
#include "field/trace/levels/level_polynomials.h"
#include "field/trace/sources/near_far.h"

namespace marrow {

/// From here on few rays meet a cell, and cells are large.
inline constexpr std::size_t many_pieces = 4'000;

/// From here on levels are more than caches hold, whatever is done: then what they are made of, a third of the memory,
/// comes as soon as they are made of it. Fewer pieces keep their levels as kernels read them, up to 1.25 GiB. A further
/// sample of 10^6 strands takes 0.87 of the time so, their first frame 0.9; of 10^5 both the same, with two thirds of
/// the memory; bounces of 10,000 hairs would take 1.05 to 1.12 times as long.
inline constexpr std::size_t too_many_pieces = 100'000;
/// Where skeletons have an angle each there are no compact levels: what is not kept would be made from the beginning.
inline std::size_t kept_bytes_for(std::size_t piece_count, bool have_angles) {
  return piece_count < too_many_pieces || have_angles ? std::size_t{5} << 28 : 0;
}

/// Of the coarse level, over the local radius: large enough to shorten its lists to a few sources, small enough to
/// bring the fine level close to the root at once.
inline constexpr double coarse_tolerance = 2e-2;

/// What one piece may contribute to a displacement of the surface by `tolerance` local radii.
/// The error of the corrected field is at most error(f) + error(G) / n (dC/df <= 1, dC/dG g'(C) <= 1 with g'(1) = n,
/// see ../README.md), and the field falls by about n - 1 over one radius. A block has some 200 sources, most of whose
/// error bounds are far below their budget.
inline ErrorBudget budget_of(double tolerance, int degree) {
  const double share = tolerance * (degree - 1) / 400;
  return {.field = share, .gradient = share * degree};
}

/// Degrees to which far sources of the fine level are gathered. To the highest one only the long lists of many pieces
/// gain what gathering takes; figures in levels/README.md.
inline int fine_far_degree_for(std::size_t piece_count) {
  return piece_count < many_pieces ? high_far_degree : highest_far_degree;
}

/// What a level evaluates. What it leaves out is an error of it, far below what counts in the coarse one.
inline constexpr Economy coarse_economy{.most = 2};

/// Polynomials of the highest degree may leave out as much as a hundred pieces may cause, a quarter of the tolerance.
/// Hits of 10,000 hairs are as exact with it as without (root mean square of C - 1 8.8e-7); those of few pieces, which
/// are more exact, would be less so (1.7e-7 to 2.3e-7). Of gentle kernels a field of many pieces is that of a large
/// body, which falls over its size, and budgets count on the radius of one: there it is ten pieces. Hits of a lattice
/// of 17 x 17 x 17 points of degree 3 are then 1.9 x 2^-23 of their distance off at most, 4.8 with a hundred (100,000
/// rays from four times its half side).
inline Economy fine_economy(const NearFar& fine) {
  constexpr int gentle = 4;
  if (fine.far_degree() < highest_far_degree) return {.most = 4};
  const double pieces = fine.degree() <= gentle ? 10 : 100;
  return {.most = 5, .f = pieces * fine.budget().field, .gradient = pieces * fine.budget().gradient};
}

/// Below it lists are so short that what the coarse level loses in degrees costs more samples than sources.
inline constexpr std::size_t few_pieces = 500;
inline int coarse_far_degree_for(std::size_t piece_count) {
  return piece_count < few_pieces ? low_far_degree : high_far_degree;
}

/// What eighths of slots save grows with the lists of sources. In turns, one thread, a further sample of 10,000 hairs
/// takes 0.92 of the time with them and bounces of the hairs 0.90, their first frame 1.09; 867 segments 0.98 and 1.16,
/// 200 points the same and 1.2. Whole pictures of the hairs with one shadow ray take the same time with 16 samples,
/// 0.975 of it with 64. Too few rays come to the cells of 10^6 strands: 16 samples take 1.08 times as long with them.
inline bool have_eighths(std::size_t piece_count, const RaySpacing* spacing) {
  constexpr int enough_samples = 16;
  const int samples = spacing != nullptr ? spacing->samples : 0;
  return piece_count >= many_pieces && piece_count < too_many_pieces && (samples == 0 || samples >= enough_samples);
}

/// Small cells have short lists, so rays are faster, but there are more of them to build. Processor time of a frame of
/// 1024 x 1024 with shadow rays, the first one with all building, at half sides of 0.35, 0.5, 0.7 and 1 radii on the
/// 867-segment workload: 4.4, 3.9, 3.3, 3.5 s first and 1.9, 2.4, 2.6, 3.1 s then. Of 10,000 hairs
/// (22,000 pieces), few of whose cells meet more than ten rays, at 0.8, 1.2, 1.6 and 2.2: 22.9, 15.2, 13.7, 13.3 s
/// and 3.5, 4.3, 4.2, 6.3 s.
inline CellTreeSettings cells_for(std::size_t piece_count) {
  return {.cell_size = piece_count < many_pieces ? 0.35 : 1.6, .tile_levels = piece_count < 50'000 ? 1 : 2};
}

}  // namespace marrow
