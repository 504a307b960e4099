// What a blend's space has been divided into so far, and rays in one part of it.
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "field/trace/blend_tracer_state.h"
#include "field/trace/cells/cell_walk.h"
#include "field/trace/cells/ray_in_cube.h"
#include "field/trace/cells/slot_layers.h"

namespace marrow {

namespace {

// Where a line is between the planes of some layers along one axis.
void clip_to_layers(const LayerSpan& layers, float origin, float direction, float& begin, float& end) {
  const float inverse = 1 / (std::fabs(direction) > 1e-20F ? direction : 1e-20F);
  const float a = (slot_planes[layers.first] - origin) * inverse, b = (slot_planes[layers.end] - origin) * inverse;
  begin = std::max(begin, std::min(a, b));
  end = std::min(end, std::max(a, b));
}

// Where a walk over the slots of the cell would begin and end.
bool clip_to_cell(const TileContent& content, int slot, const LocalRay& ray, float& begin, float& end) {
  for (int k = 0; k < 3; ++k) clip_to_layers(layers_of(content, slot, k), ray.origin[k], ray.direction[k], begin, end);
  return begin < end;
}

Box3 box_of(const Tile& tile, int slot) {
  const Vec3d center = slot_center(tile.place().center, tile.place().half, slot);
  const Vec3d h = Vec3d{1, 1, 1} * (tile.place().half / 4);
  return {center - h, center + h};
}

}  // namespace

std::optional<BlendTracer::Stretch> BlendTracer::stretch_in(const Tile& tile, const Ray& ray, bool any) const {
  const TilePlace& place = tile.place();
  if (place.parent != nullptr) return stretch_in(*place.parent, place.slot, ray, any);
  const auto [enter, exit] = clip_to_tile(tile, ray, any);
  if (!(enter < exit)) return {};
  return Stretch{enter, exit};
}

std::optional<BlendTracer::Stretch> BlendTracer::stretch_in(const Tile& tile, int slot, const Ray& ray,
                                                            bool any) const {
  const auto whole = stretch_in(tile, ray, any);
  if (!whole) return {};
  const RayInCube cube(ray, tile.place().center, tile.place().half);
  const float first = cube.to_local(whole->enter);
  float begin = first, end = cube.to_local(whole->exit);
  if (!clip_to_cell(tile.content(), slot, cube.local, begin, end)) return {};
  return Stretch{begin <= first ? whole->enter : std::max(whole->enter, cube.to_world(begin)),
                 std::min(whole->exit, cube.to_world(end))};
}

// Where a ray is in a part, and what is known of it there.
std::optional<BlendTracer::Stretch> BlendTracer::enter(const TracePart& part, const Ray& ray, bool any,
                                                       CellLog& log) const {
  log.side = Side::Unknown;
  const auto stretch = stretch_in(*part.within, part.slot, ray, any);
  if (!stretch) return {};
  log.enter = stretch->enter;
  if (stretch->enter >= log.outside_from) log.side = Side::Outside;
  return stretch;
}

namespace {

// Where the ray begins in this part, it begins outside.
void pass_on_side(const Ray& ray, double enter, double exit, CellLog& log) {
  if (log.side == Side::Outside) log.outside_from = std::min(log.outside_from, enter <= ray.t_min ? ray.t_min : exit);
}

}  // namespace

std::optional<CellHit> BlendTracer::first_hit(const TracePart& part, const Ray& ray, bool any, CellLog& log) const {
  if (part.within == nullptr) return first_hit(part.tile, ray, any, log);
  const auto stretch = enter(part, ray, any, log);
  if (!stretch) return {};
  const auto hit =
      part.within->content().is_cell(part.slot)
          ? hit_in(*part.within, part.slot, ray, any, stretch->enter, stretch->exit, log)
          : hit_in(state_->tree.child(*part.within, part.slot), ray, any, stretch->enter, stretch->exit, log);
  if (log.side == Side::Inside) return {};
  if (any && hit && is_at_end(*hit, ray.t_max)) return first_hit(part, ray, false, log);
  pass_on_side(ray, stretch->enter, stretch->exit, log);
  return hit && hit->t <= ray.t_max ? hit : std::nullopt;
}

std::vector<TracePart> BlendTracer::parts() const {
  std::vector<TracePart> parts;
  for (std::size_t i = 0; i < tile_count(); ++i) {
    const Tile* made = state_->tree.tile_if_made(i);
    if (made == nullptr) parts.push_back({.tile = i, .within = nullptr, .slot = 0, .box = tile_box(i)});
    else add_parts(i, *made, parts);
  }
  return parts;
}

void BlendTracer::add_parts(std::size_t tile, const Tile& within, std::vector<TracePart>& parts) const {
  const TileContent& content = within.content();
  for (std::uint64_t left = content.cells; left != 0; left &= left - 1) {
    const int slot = std::countr_zero(left);
    const Block* made = within.block(slot).peek();
    const Box3 box = made != nullptr ? made->surface_box() : CellTree::cell(within, slot).box();
    if (!box.empty()) parts.push_back({tile, &within, slot, box});
  }
  for (std::uint64_t left = content.tiles; left != 0; left &= left - 1) {
    const int slot = std::countr_zero(left);
    if (const Tile* made = within.child(slot).peek()) add_parts(tile, *made, parts);
    else parts.push_back({tile, &within, slot, box_of(within, slot)});
  }
}

}  // namespace marrow
