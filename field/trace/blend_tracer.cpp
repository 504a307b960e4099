#include "field/trace/blend_tracer.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "field/trace/blend_tracer_state.h"
#include "field/trace/cells/cell_walk.h"
#include "field/trace/cells/ray_in_cube.h"
#include "field/trace/side_bound.h"

namespace marrow {

std::string BlendTracer::refusal(const BlendField& field) {
  if (std::string part = untraceable_part(field); !part.empty()) return part;
  // Without an f from which on all is inside, no distance to a skeleton is certainly inside.
  if (!(critical_field_of(correction_for(field)) < 100))
    return "`cavity: false` with so small an `alpha` lets holes open anywhere inside; it can be evaluated (probe, "
           "slice) but not rendered";
  return {};
}

Result<std::unique_ptr<BlendTracer>> BlendTracer::make(BlendField field, const TraceOptions& options) {
  if (const std::string why = refusal(field); !why.empty()) return failure(why);
  const BlockKernels* kernels = block_kernels(options.instruction_set);
  if (kernels == nullptr)
    return failure("instruction set \"" + options.instruction_set + "\" is unknown or not of this machine");
  return std::unique_ptr<BlendTracer>(new BlendTracer(std::make_unique<State>(std::move(field), options, *kernels)));
}

BlendTracer::BlendTracer(std::unique_ptr<State> state) : state_(std::move(state)) {}
BlendTracer::~BlendTracer() = default;

std::size_t BlendTracer::tile_count() const { return state_->tree.tile_count(); }
Box3 BlendTracer::tile_box(std::size_t tile) const { return state_->tree.tile_box(tile); }
const Box3& BlendTracer::bounds() const { return state_->bounds; }
const BlendField& BlendTracer::field() const { return state_->field; }
MaterialId BlendTracer::material_at(const Vec3d& p) const { return state_->materials.at(p); }

const Block& BlendTracer::block(const Tile& tile, int slot) const {
  return tile.block(slot).get(
      [&] { return std::make_unique<const Block>(state_->context, CellTree::cell(tile, slot)); });
}

// Null, and noted, where a cell turns out to hold no surface.
const Block* BlendTracer::block_to_search(const Tile& tile, int slot) const {
  const Block& made = block(tile, slot);
  if (!made.empty()) return &made;
  tile.note_empty(slot);
  return nullptr;
}

std::optional<CellHit> BlendTracer::first_hit(std::size_t tile, const Ray& ray, bool any, CellLog& log) const {
  const Tile& made = state_->tree.tile(tile);
  const auto [enter, exit] = clip_to_tile(made, ray, any);
  log.enter = enter;
  log.side = Side::Unknown;
  if (!(enter < exit)) return {};
  const auto hit = hit_in(made, ray, any, enter, exit, log);
  if (any && hit && is_at_end(*hit, ray.t_max)) return first_hit(tile, ray, false, log);
  return hit && hit->t <= ray.t_max ? hit : std::nullopt;
}

std::optional<CellHit> BlendTracer::hit_in(const Tile& tile, const Ray& ray, bool any, double enter, double exit,
                                           CellLog& log) const {
  CellWalk walk;
  walk.start(state_->tree, state_->kernels, tile, ray, enter, exit);
  for (CellStep step; walk.next(step);)
    if (const auto hit = hit_in(*step.tile, step.slot, ray, any, step.enter, step.exit, log)) return hit;
  return {};
}

// Whether a ray begins inside there: asked only when a block is entered inside. By the exact field where bounds do not
// tell. Rays of a camera share their beginning.
bool BlendTracer::is_inside(const Vec3d& beginning) const {
  struct Place {
    std::uint64_t tracer = 0;
    Vec3d at;
    bool inside = false;
  };
  thread_local Place last;
  if (last.tracer == state_->serial && last.at == beginning) return last.inside;
  const Side side = clear_side(beginning);
  const bool inside = side == Side::Unknown ? corrected_value(state_->field, beginning) >= 1 : side == Side::Inside;
  last = {state_->serial, beginning, inside};
  return inside;
}

std::optional<CellHit> BlendTracer::hit_in(const Tile& tile, int slot, const Ray& ray, bool any, double enter,
                                           double exit, CellLog& log) const {
  const Block* searched = block_to_search(tile, slot);
  if (searched == nullptr) return {};
  const Block& b = *searched;
  const RayInCube cube(ray, b.center(), b.half());
  BlockKernels::Query query{.t0 = cube.to_local(enter),
                            .t1 = cube.to_local(exit),
                            .any = any,
                            .from_surface = enter <= ray.t_min,
                            .from_outside = log.side == Side::Outside,
                            .leaving = log.side == Side::Inside,
                            .around = ray.around};
  Root root = state_->kernels.first_root(b.view(), cube.local, query);
  // By rounding a place in the block may come before it is entered.
  const auto behind_entry = [&](float t) { return std::max(cube.to_world(t), enter); };
  const auto note = [&] { log.add({behind_entry(root.searched_from), static_cast<std::uint32_t>(root.evaluations)}); };
  note();
  if (root.begins_outside) log.side = Side::Outside;
  if (root.enters_inside && is_inside(ray.at(ray.t_min))) {
    log.side = Side::Inside;
    query.leaving = true;
    root = state_->kernels.first_root(b.view(), cube.local, query);
    note();
  }
  log.undecided = std::min(log.undecided, behind_entry(root.undecided));
  if (!root.hit) return {};
  const double t = behind_entry(root.t);
  const bool ends = any && !query.leaving && t > ray.t_max - nearly_ended * b.half();
  return CellHit{ends ? ray.t_max : t, &b};
}

// All that is inside lies within the bounds.
Side BlendTracer::clear_side(const Vec3d& p) const {
  if (!state_->bounds.contains(p)) return Side::Outside;
  return SideBound(state_->sources, state_->coarse, state_->iso).side(p);
}

Side BlendTracer::clear_side(const Box3& box) const {
  if (!do_overlap(box, state_->bounds)) return Side::Outside;
  return SideBound(state_->sources, state_->coarse, state_->iso).side(box);
}

double BlendTracer::crossing_length(const Vec3d& position) const {
  double nearest = Box3::inf;
  for (const Piece& piece : state_->sources.pieces()) nearest = std::min(nearest, distance(piece, position));
  return static_cast<double>(crossing_gap) * nearest;
}

bool BlendTracer::leaves_surface(const Ray& ray) const {
  if (ray.around == nullptr || ray.around->block == nullptr) return false;
  const Block& b = *static_cast<const Block*>(ray.around->block);
  if (&b.context() != &state_->context) return false;
  // As near as departures (kernels/departure.h) want it.
  const Vec3d begin = (ray.at(ray.t_min) - b.center()) / b.half();
  const float* place = ray.around->place;
  return length(begin - Vec3d{place[0], place[1], place[2]}) < 0.01 * ray.around->field.nearest;
}

TraceStatistics BlendTracer::statistics() const {
  TraceStatistics s;
  const CellTree::Size size = state_->tree.size();
  s.tiles = tile_count();
  s.cells = size.cells;
  s.bytes = size.bytes + state_->sources.bytes() + state_->arena.bytes();
  state_->tree.for_each_tile(false, [&](const Tile& tile) {
    for (std::uint64_t left = tile.content().cells; left != 0; left &= left - 1) {
      const Block* b = tile.block(std::countr_zero(left)).peek();
      if (b == nullptr) continue;
      ++s.blocks;
      s.bytes += sizeof(Block);
      if (b->patches() != nullptr) s.bytes += b->patches()->bytes();
      const BlockLevel* fine = b->fine_if_kept();
      if (fine == nullptr) continue;
      s.sources += static_cast<std::size_t>((fine->level.curve_groups + fine->level.point_groups) * lanes);
      s.largest_error = std::max(s.largest_error, state_->largest_error(*fine, b->patches()));
    }
  });
  return s;
}

}  // namespace marrow
