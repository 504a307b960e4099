// Packets of rays in tiles and cells: those that come to the same cell are traced in it together.
#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <memory>

#include "field/trace/blend_tracer_state.h"
#include "field/trace/cell_walk.h"
#include "field/trace/slot_layers.h"

namespace marrow {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Of this thread, whose stack may be small.
struct Memory {
  std::array<CellWalk, RayPacket::size> walks;
  PacketMemory search;
};
Memory& memory() {
  thread_local const std::unique_ptr<Memory> own = std::make_unique_for_overwrite<Memory>();
  return *own;
}

PacketView view_of(const RayPacket& packet) {
  return {{packet.origin[0], packet.origin[1], packet.origin[2]},
          {packet.direction[0], packet.direction[1], packet.direction[2]},
          packet.t_min,
          packet.t_max};
}

TileLayers layers_in(const Tile& tile, int slot) {
  const TilePlace& place = tile.place();
  TileLayers out{.center = {place.center.x, place.center.y, place.center.z},
                 .half = place.half,
                 .first_plane = {},
                 .end_plane = {}};
  for (std::size_t k = 0; k < 3; ++k) {
    const LayerSpan layers = layers_of(tile.content(), slot, static_cast<int>(k));
    out.first_plane[k] = slot_planes[layers.first];
    out.end_plane[k] = slot_planes[layers.end];
  }
  return out;
}

int tiles_above(const Tile& tile) { return tile.place().parent == nullptr ? 0 : 1 + tiles_above(*tile.place().parent); }

void set_block(CellPlace& place, const Block& block) {
  for (std::size_t k = 0; k < 3; ++k) place.block_center[k] = block.center()[k];
  place.block_half = block.half();
}

CellPlace place_of(const TracePart& part, const Block& block) {
  CellPlace place;
  const Tile* tile = part.within;
  int slot = part.slot;
  place.tile_count = tiles_above(*tile) + 1;
  for (int i = place.tile_count - 1; i >= 0; --i) {
    place.tiles[i] = layers_in(*tile, slot);
    if (i == 0) break;
    slot = tile->place().slot;
    tile = tile->place().parent;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    place.box_lower[k] = tile->content_box().lower[k];
    place.box_upper[k] = tile->content_box().upper[k];
  }
  set_block(place, block);
  return place;
}

void add_to(CellLog& log, const CellRoots& roots, std::size_t lane) {
  log.add({roots.searched_from[lane], static_cast<std::uint32_t>(roots.evaluations[lane])});
  if (roots.begins_outside >> lane & 1) log.side = CellLog::Side::Outside;
  log.undecided = std::min(log.undecided, roots.undecided[lane]);
}

}  // namespace

bool BlendTracer::traces_packets() const { return !state_->range || state_->strands; }

void BlendTracer::first_hits(const TracePart& part, const RayPacket& packet, LaneSet rays, bool any,
                             CellHits& out) const {
  if (part.within == nullptr) return first_hits(part.tile, packet, rays, any, out);
  if (traces_packets() && part.within->content().is_cell(part.slot) &&
      tiles_above(*part.within) < CellPlace::most_tiles) {
    const Block& b = block(*part.within, part.slot);
    if (!b.empty()) return first_hits_in_cell(part, b, packet, rays, any, out);
  }
  for_each_lane(
      rays, [&](std::size_t i) { out.hit[i] = first_hit(part, packet.ray(i), any, out.log[i]).value_or(CellHit{}); });
}

void BlendTracer::first_hits_in_cell(const TracePart& part, const Block& b, const RayPacket& packet, LaneSet rays,
                                     bool any, CellHits& out) const {
  CellRoots roots;
  for_each_lane(rays, [&](std::size_t i) { roots.outside_from[i] = out.log[i].outside_from; });
  state_->kernels.roots_in_cell(b.view(), place_of(part, b), view_of(packet), rays, any, memory().search, roots);
  for_each_lane(rays, [&](std::size_t i) {
    CellLog& log = out.log[i];
    out.hit[i] = {};
    log.side = CellLog::Side::Unknown;
    if (!(roots.entered >> i & 1)) return;
    if (roots.enters_inside >> i & 1) {  // it may begin inside: that is asked one by one
      out.hit[i] = first_hit(part, packet.ray(i), any, log).value_or(CellHit{});
      return;
    }
    log.enter = roots.enter[i];
    add_to(log, roots, i);
    log.outside_from = roots.outside_from[i];
    if (roots.hit >> i & 1) out.hit[i] = {roots.t[i], &b};
  });
}

// Each ray goes from cell to cell as it would alone. Those that wait at the cell that any of them comes to first are
// traced together.
void BlendTracer::first_hits(std::size_t tile, const RayPacket& packet, LaneSet rays, bool any, CellHits& out) const {
  if (!traces_packets()) {
    for_each_lane(
        rays, [&](std::size_t i) { out.hit[i] = first_hit(tile, packet.ray(i), any, out.log[i]).value_or(CellHit{}); });
    return;
  }
  const Tile& made = state_->tree.tile(tile);
  std::array<CellWalk, RayPacket::size>& walks = memory().walks;
  CellSteps steps;
  LaneSet open = 0;
  const auto go_on = [&](std::size_t i) { open = walks[i].next(steps[i]) ? open | lane_bit(i) : open & ~lane_bit(i); };
  for_each_lane(rays, [&](std::size_t i) {
    const Ray ray = packet.ray(i);
    out.hit[i] = {};
    auto [enter, exit] = clip_to_tile(made, ray, any);
    out.log[i].enter = enter;
    out.log[i].side = CellLog::Side::Unknown;
    if (!(enter < exit)) return;
    walks[i].start(state_->tree, state_->kernels, made, ray, enter, exit);
    go_on(i);
  });
  while (open != 0) {
    std::size_t first = 0;
    double nearest = infinity;
    for_each_lane(open, [&](std::size_t i) {
      if (!(steps[i].enter < nearest)) return;
      nearest = steps[i].enter;
      first = i;
    });
    LaneSet together = 0;
    for_each_lane(open,
                  [&](std::size_t i) { together |= static_cast<LaneSet>(steps[i].is_cell_of(steps[first])) << i; });
    const LaneSet hit = hits_in(steps, together, packet, any, out);
    open &= ~hit;
    for_each_lane(together & ~hit, go_on);
  }
}

// Returns which rays meet the surface in the cell.
LaneSet BlendTracer::hits_in(const CellSteps& steps, LaneSet rays, const RayPacket& packet, bool any,
                             CellHits& out) const {
  const CellStep& cell = steps[static_cast<std::size_t>(std::countr_zero(rays))];
  const Block& b = block(*cell.tile, cell.slot);
  if (b.empty()) {
    cell.tile->note_empty(cell.slot);
    return 0;
  }
  LaneSet hit = 0;
  const auto alone = [&](std::size_t i) {
    const CellStep& step = steps[i];
    const auto found = hit_in(*step.tile, step.slot, packet.ray(i), any, step.enter, step.exit, out.log[i]);
    if (!found) return;
    hit |= lane_bit(i);
    if (found->t <= packet.t_max[i]) out.hit[i] = *found;
  };
  // Those that go together, in the first lanes of a packet of their own.
  RayPacket close;
  CellRoots roots;
  std::array<std::size_t, RayPacket::size> lane_of;
  std::size_t count = 0;
  for_each_lane(rays, [&](std::size_t i) {
    if (out.log[i].side == CellLog::Side::Inside || std::has_single_bit(rays)) return alone(i);
    close.set(count, packet.ray(i));
    roots.enter[count] = steps[i].enter;
    roots.exit[count] = steps[i].exit;
    roots.outside_from[count] = out.log[i].side == CellLog::Side::Outside ? -infinity : infinity;
    lane_of[count++] = i;
  });
  CellPlace place;
  set_block(place, b);
  state_->kernels.roots_between(b.view(), place, view_of(close), first_lanes(count), any, memory().search, roots);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = lane_of[k];
    if (roots.enters_inside >> k & 1) {
      alone(i);
      continue;
    }
    add_to(out.log[i], roots, k);
    if (!(roots.met >> k & 1)) continue;
    hit |= lane_bit(i);
    if (roots.hit >> k & 1) out.hit[i] = {roots.t[k], &b};
  }
  return hit;
}

}  // namespace marrow
