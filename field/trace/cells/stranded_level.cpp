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
                    .directions = {},
                    .have_own_angles = strands.have_own_angles(),
                    .angles = {},
                    .point_crossing = {}};
  SourceEmitter emitter(context.cutter, context.fine, cell.center, cell.half);
  int lanes_told = 0;
  const auto emit = [&](std::uint32_t piece, double share) {
    emitter.emit(context.pieces[piece], share);
    if (out.have_own_angles && context.pieces[piece].is_point()) {
      out.point_crossing.resize(static_cast<std::size_t>(emitter.points.group_count()) * lanes);
      out.point_crossing[static_cast<std::size_t>(emitter.points.count() - 1)] = strands.angle_of_piece(piece).crossing;
    }
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
    if (out.have_own_angles) out.angles.push_back(strands.angle_of_strand(out.seen.view.near[i]));
  }
  out.curves = std::move(emitter.curves);
  out.points = std::move(emitter.points);
  return out;
}

namespace {

// Arrays behind each other, in whole groups of lanes.
class Room {
 public:
  explicit Room(float* at) : at_(at) {}

  template <class T>
  static std::size_t floats_of(const std::vector<T>& all) {
    static_assert(sizeof(T) % sizeof(float) == 0);
    return (all.size() * (sizeof(T) / sizeof(float)) + lanes - 1) / lanes * lanes;
  }
  template <class T>
  T* put(const std::vector<T>& all) {
    T* const to = reinterpret_cast<T*>(at_);
    std::uninitialized_copy(all.begin(), all.end(), to);
    at_ += floats_of(all);
    return to;
  }
  void* rest() const { return at_; }

 private:
  float* at_;
};

// StrandLevel::rest: its four numbers of each monomial, strand after strand in whole groups of lanes.
std::vector<float> rests_of(const std::vector<NearStrand>& near) {
  const std::size_t stride = (near.size() + lanes - 1) / lanes * lanes, row = 4 * stride;
  std::vector<float> rests(quadratic_monomials * row, 0.0F);
  for (std::size_t i = 0; i < near.size(); ++i)
    for (std::size_t m = 0; m < quadratic_monomials; ++m)
      for (std::size_t k = 0; k < 4; ++k) rests[m * row + k * stride + i] = near[i].rest[4 * m + k];
  return rests;
}

}  // namespace

// The sources, then what goes with the strands, and what refers to that.
BlockLevel write_stranded_level(const StrandedLevel& from, const Allocate& allocate) {
  constexpr std::size_t reference_floats = (sizeof(StrandLevel) + sizeof(float) - 1) / sizeof(float);
  const CellStrands& seen = from.seen;
  const std::vector<float> rests = rests_of(seen.near);
  const std::size_t own = source_floats(from.curves, from.points);
  float* const at = allocate(own + Room::floats_of(from.directions) + Room::floats_of(seen.far) +
                             Room::floats_of(rests) + Room::floats_of(from.groups) + Room::floats_of(from.angles) +
                             Room::floats_of(from.point_crossing) + reference_floats);
  Room room(at + own);
  StrandLevel strands{.directions = room.put(from.directions),
                      .groups = room.put(from.groups),
                      .rest = room.put(rests),
                      .count = static_cast<int>(from.groups.size()),
                      .far = room.put(seen.far)};
  if (from.have_own_angles) {
    strands.angles = room.put(from.angles);
    strands.point_crossing = room.put(from.point_crossing);
    strands.far_weighted = strands.far + quadratics_of_tensor;
  }
  BlockLevel out;
  out.level = write_sources(from.curves, from.points, at);
  out.angle_error = seen.view.share_error();
  out.is_weak = seen.is_weak;
  out.level.strands = new (room.rest()) StrandLevel(strands);
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
  const AngleRange& range = context.strands->range();
  for (std::size_t k = 0; k < strand_places; ++k) {
    const AngleShare share = exact_share(blend, range, middle + place_in_cube(k) * side);
    found.share[k] = static_cast<float>(share.value);
    for (std::size_t e = 0; e < 3; ++e) found.slope[e][k] = static_cast<float>(share.gradient[e] * cell.half);
  }
  return 0;
}

}  // namespace marrow
