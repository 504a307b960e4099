// Packets of rays in tiles and cells: those that come to the same cell are traced in it together.
#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "field/trace/blend_tracer_state.h"
#include "field/trace/cells/cell_walk.h"
#include "field/trace/cells/slot_layers.h"

namespace marrow {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Of this thread, whose stack may be small.
struct Memory {
  std::array<CellWalk, RayPacket::size> walks;
  CellSteps steps;
  std::array<CellRays, RayPacket::size> cells;
  CellRoots roots;
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
          packet.t_max,
          packet.around};
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

CellPlace place_of(const TracePart& part) {
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
  return place;
}

// What rays need of a cell lies here and there, each thing where the one before tells: if each cell were asked for by
// itself, its rays would wait for one after the other.
void ask_for_cells(std::span<const PartRays> parts) {
  const auto for_each_cell = [&](const auto& ask) {
    for (const auto& [part, rays] : parts)
      if (part.within != nullptr) ask(*part.within, part.slot);
  };
  const auto ask_for_block = [](const Tile& tile, int slot) {
    if (!tile.content().is_cell(slot)) return;
    if (const Block* made = tile.block(slot).peek()) made->ask_for();
  };
  for_each_cell([](const Tile& tile, int) { tile.ask_for(); });
  for_each_cell([](const Tile& tile, int slot) {
    if (tile.content().is_cell(slot)) ask_for_lines<1>(&tile.block(slot));
  });
  for_each_cell(ask_for_block);
}

// By rounding a place in the block may come before it is entered.
void add_to(CellLog& log, const CellRoots& roots, std::size_t lane) {
  const auto behind_entry = [&](double t) { return std::max(t, roots.enter[lane]); };
  log.add({behind_entry(roots.searched_from[lane]), static_cast<std::uint32_t>(roots.evaluations[lane])});
  if (roots.begins_outside.has(lane)) log.side = Side::Outside;
  log.undecided = std::min(log.undecided, behind_entry(roots.undecided[lane]));
}

}  // namespace

// Rays of a packet that are to be searched together, each in its cell. Only one at a time in a thread.
class BlendTracer::CellGroup {
 public:
  CellGroup(const BlendTracer& tracer, const RayPacket& packet, bool any)
      : kernels_(tracer.state_->kernels), rays_(view_of(packet)), any_(any) {}

  CellRoots& roots = memory().roots;  // in: outside_from of all rays; enter and exit of those that join()

  // Those of the rays that come into the cell join. `key`: to know it by.
  void enter(const TracePart& part, const Block& block, std::size_t key, const LaneSet& rays) {
    join(block, key, kernels_.enter_cell(place_of(part), rays_, rays, any_, roots));
  }
  void join(const Block& block, std::size_t key, const LaneSet& rays) {
    if (rays.empty()) return;
    cells_[count_] = {&block.view(), {block.center().x, block.center().y, block.center().z}, block.half(), rays};
    members_[count_++] = {&block, key};
  }
  // Calls found(block, key, rays) for each cell: `roots` are of them. Then nobody is left.
  template <class Found>
  void search(const Found& found) {
    if (count_ == 0) return;
    kernels_.roots_between(cells_.data(), static_cast<int>(count_), rays_, any_, memory().search, roots);
    for (std::size_t i = 0; i < count_; ++i) found(*members_[i].block, members_[i].key, cells_[i].rays);
    count_ = 0;
  }

 private:
  struct Member {
    const Block* block;
    std::size_t key;
  };
  const BlockKernels& kernels_;
  const PacketView rays_;
  const bool any_;
  std::array<CellRays, RayPacket::size>& cells_ = memory().cells;
  std::array<Member, RayPacket::size> members_;
  std::size_t count_ = 0;
};

bool BlendTracer::traces_packets() const { return !state_->range || state_->strands; }

// Null where rays have to be traced one by one.
const Block* BlendTracer::block_for_packets(const TracePart& part) const {
  if (!traces_packets() || !part.within->content().is_cell(part.slot) ||
      tiles_above(*part.within) >= CellPlace::most_tiles)
    return nullptr;
  const Block& b = block(*part.within, part.slot);
  return b.empty() ? nullptr : &b;
}

void BlendTracer::first_hits(std::span<const PartRays> parts, const RayPacket& packet, bool any, CellHits& out) const {
  for (const auto& [part, rays] : parts)
    if (part.within == nullptr) first_hits(part.tile, packet, rays, any, out);
  ask_for_cells(parts);
  CellGroup group(*this, packet, any);
  const auto alone = [&](const TracePart& part, std::size_t i) {
    out.hit[i] = first_hit(part, packet.ray(i), any, out.log[i]).value_or(CellHit{});
  };
  const auto take = [&](const Block& block, std::size_t part, const LaneSet& rays) {
    rays.for_each([&](std::size_t i) {
      const CellRoots& roots = group.roots;
      const CellHit hit = roots.hit.has(i) ? CellHit{roots.t[i], &block} : CellHit{};
      const bool may_begin_inside = roots.enters_inside.has(i), at_end = any && is_at_end(hit, packet.t_max[i]);
      if (may_begin_inside || at_end) return alone(parts[part].part, i);
      out.log[i].enter = roots.enter[i];
      add_to(out.log[i], roots, i);
      out.log[i].outside_from = roots.outside_from[i];
      out.hit[i] = hit;
    });
  };
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto& [part, rays] = parts[k];
    if (part.within == nullptr) continue;
    const Block* block = block_for_packets(part);
    if (block == nullptr) {
      rays.for_each([&](std::size_t i) { alone(part, i); });
      continue;
    }
    rays.for_each([&](std::size_t i) {
      group.roots.outside_from[i] = out.log[i].outside_from;
      out.hit[i] = {};
      out.log[i].side = Side::Unknown;
    });
    group.enter(part, *block, k, rays);
  }
  group.search(take);
}

// Each ray goes from cell to cell as it would alone, all of them at the same time.
void BlendTracer::first_hits(std::size_t tile, const RayPacket& packet, const LaneSet& rays, bool any,
                             CellHits& out) const {
  if (!traces_packets()) {
    rays.for_each(
        [&](std::size_t i) { out.hit[i] = first_hit(tile, packet.ray(i), any, out.log[i]).value_or(CellHit{}); });
    return;
  }
  const Tile& made = state_->tree.tile(tile);
  std::array<CellWalk, RayPacket::size>& walks = memory().walks;
  CellSteps& steps = memory().steps;
  LaneSet open;
  const auto go_on = [&](std::size_t i) {
    if (walks[i].next(steps[i])) open.add(i);
    else open.remove(i);
  };
  rays.for_each([&](std::size_t i) {
    const Ray ray = packet.ray(i);
    out.hit[i] = {};
    auto [enter, exit] = clip_to_tile(made, ray, any);
    out.log[i].enter = enter;
    out.log[i].side = Side::Unknown;
    if (!(enter < exit)) return;
    walks[i].start(state_->tree, state_->kernels, made, ray, enter, exit);
    go_on(i);
  });
  while (!open.empty()) {
    open &= ~hits_in(steps, open, packet, any, out);
    const LaneSet here = open;
    here.for_each(go_on);
  }
  if (!any) return;
  rays.for_each([&](std::size_t i) {
    if (!is_at_end(out.hit[i], packet.t_max[i])) return;
    out.hit[i] = first_hit(tile, packet.ray(i), false, out.log[i]).value_or(CellHit{});
  });
}

// Returns which rays meet the surface in the cells where they are.
LaneSet BlendTracer::hits_in(const CellSteps& steps, const LaneSet& rays, const RayPacket& packet, bool any,
                             CellHits& out) const {
  LaneSet hit, together;
  const bool single = rays.count() == 1;
  const auto alone = [&](std::size_t i) {
    const CellStep& step = steps[i];
    const auto found = hit_in(*step.tile, step.slot, packet.ray(i), any, step.enter, step.exit, out.log[i]);
    if (!found) return;
    hit.add(i);
    if (found->t <= packet.t_max[i]) out.hit[i] = *found;
  };
  CellGroup group(*this, packet, any);
  rays.for_each([&](std::size_t i) {
    if (out.log[i].side == Side::Inside || single) return alone(i);
    group.roots.enter[i] = steps[i].enter;
    group.roots.exit[i] = steps[i].exit;
    group.roots.outside_from[i] = out.log[i].side == Side::Outside ? -infinity : infinity;
    together.add(i);
  });
  const auto take = [&](const Block& block, std::size_t, const LaneSet& in_block) {
    in_block.for_each([&](std::size_t i) {
      const CellRoots& roots = group.roots;
      if (roots.enters_inside.has(i)) return alone(i);
      add_to(out.log[i], roots, i);
      if (!roots.met.has(i)) return;
      hit.add(i);
      if (roots.hit.has(i)) out.hit[i] = {roots.t[i], &block};
    });
  };
  while (!together.empty()) {
    const CellStep& cell = steps[static_cast<std::size_t>(together.lowest())];
    LaneSet here;
    together.for_each([&](std::size_t i) {
      if (steps[i].is_cell_of(cell)) here.add(i);
    });
    together &= ~here;
    const Block& b = block(*cell.tile, cell.slot);
    if (b.empty()) cell.tile->note_empty(cell.slot);
    else group.join(b, 0, here);
  }
  group.search(take);
  return hit;
}

}  // namespace marrow
