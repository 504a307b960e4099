#include "field/trace/cells/stranded_level.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <utility>

#include "field/trace/cells/weak_strands.h"
#include "field/trace/kernels/strand_places.h"
#include "field/trace/levels/level_buffer.h"
#include "field/trace/sources/source_emitter.h"

namespace marrow {

StrandedLevel make_stranded_level(const Block::Context& context, const CellTree::Cell& cell) {
  const Strands& strands = *context.strands;
  StrandedLevel out{.curves = {},
                    .points = {},
                    .seen = strands.around(*cell.tile, cell.center, cell.half),
                    .groups = {},
                    .directions = {}};
  SourceEmitter emitter(context.cutter, context.fine, cell.center, cell.half);
  int lanes_told = 0;
  const auto emit = [&](std::uint32_t piece, double share) {
    emitter.emit(context.pieces[piece], share);
    const Vec3d u = strands.direction(piece);
    out.directions.resize(static_cast<std::size_t>(emitter.curves.group_count()) * 3 * lanes);
    for (; lanes_told < emitter.curves.count(); ++lanes_told)
      for (std::size_t k = 0; k < 3; ++k)
        out.directions[static_cast<std::size_t>(lanes_told / lanes * 3 * lanes + lanes_told % lanes) + k * lanes] =
            static_cast<float>(u[k]);
  };
  // What the strongest is off turns it by as little as it is off over itself; all others count over each other, unless
  // they are none, or so weak that the blend itself is asked.
  const bool others_count = out.seen.view.others > 0 && !out.seen.is_weak;
  const double of_others =
      others_count ? std::min(1.0, Strands::budget_of(out.seen.view) / context.fine.budget().field) : 1;
  for (std::size_t i = 0; i < out.seen.near.size(); ++i) {
    const NearStrand& strand = out.seen.near[i];
    const bool is_strongest = out.seen.view.near[i] == out.seen.view.strongest;
    const int before = emitter.curves.group_count();
    const double error = emitter.rules.f_error;
    for (const std::uint32_t piece : strand.listed) emit(piece, is_strongest ? 1 : of_others);
    if (!is_strongest) out.seen.view.error += emitter.rules.f_error - error;
    emitter.curves.end_group();
    lanes_told = emitter.curves.count();
    out.groups.push_back(emitter.curves.group_count() - before);
  }
  out.curves = std::move(emitter.curves);
  out.points = std::move(emitter.points);
  return out;
}

// The sources, then their directions, the far strands, the rests of near ones, the counts of their groups, and what
// refers to them.
BlockLevel write_stranded_level(const StrandedLevel& from, const Allocate& allocate) {
  const auto floats_of = [](std::size_t n) { return (n + lanes - 1) / lanes * lanes; };
  constexpr std::size_t reference_floats = (sizeof(StrandLevel) + sizeof(float) - 1) / sizeof(float);
  const CellStrands& seen = from.seen;
  const std::size_t own = source_floats(from.curves, from.points), count = from.groups.size();
  const std::size_t stride = floats_of(count), row = 4 * stride;
  float* const at =
      allocate(own + from.directions.size() + seen.far.size() + quadratic_monomials * row + stride + reference_floats);
  float* const directions = at + own;
  float* const far = std::copy(from.directions.begin(), from.directions.end(), directions);
  float* const rest = std::copy(seen.far.begin(), seen.far.end(), far);
  std::fill_n(rest, quadratic_monomials * row, 0.0F);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t m = 0; m < quadratic_monomials; ++m)
      for (std::size_t k = 0; k < 4; ++k) rest[m * row + k * stride + i] = seen.near[i].rest[4 * m + k];
  auto* const groups = reinterpret_cast<int*>(rest + quadratic_monomials * row);
  std::uninitialized_copy(from.groups.begin(), from.groups.end(), groups);
  auto* const reference = new (rest + quadratic_monomials * row + stride) StrandLevel{
      .directions = directions, .groups = groups, .rest = rest, .count = static_cast<int>(count), .far = far};
  BlockLevel out;
  out.level = write_sources(from.curves, from.points, at);
  out.angle_error = seen.view.share_error();
  out.is_weak = seen.is_weak;
  out.level.strands = reference;
  return out;
}

namespace {

// Of this thread, for as many strands as any level had.
float* memory_for(int strands) {
  thread_local LevelBuffer buffer;
  return buffer.allocate(static_cast<std::size_t>(strands) * floats_per_strand);
}

}  // namespace

double find_shares(const Block::Context& context, const CellTree::Cell& cell, const BlockLevel& from,
                   const float (&center)[3], float half, StrandShares& found) {
  if (!from.is_weak) {
    float* const memory = memory_for(from.level.strands->count);
    context.kernels.strand_shares(from.level, context.degree, center, half, memory, found);
    return from.angle_error;
  }
  found = {};
  const Vec3d in_block{static_cast<double>(center[0]), static_cast<double>(center[1]), static_cast<double>(center[2])};
  const Vec3d middle = cell.center + in_block * cell.half;
  const double side = static_cast<double>(half) * cell.half;
  const BlendField blend = counting_strands(context.strands->blend(), middle, std::sqrt(3.0) * side);
  for (std::size_t k = 0; k < strand_places; ++k) {
    const AngleShare share = exact_share(blend, middle + place_in_cube(k) * side);
    found.share[k] = static_cast<float>(share.value);
    for (std::size_t e = 0; e < 3; ++e) found.slope[e][k] = static_cast<float>(share.gradient[e] * cell.half);
  }
  return 0;
}

}  // namespace marrow
