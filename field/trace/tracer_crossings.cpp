// Crossings of which some do not count, cell by cell.
#include <algorithm>

#include "field/trace/blend_tracer_state.h"
#include "field/trace/cells/cell_walk.h"
#include "field/trace/cells/ray_in_cube.h"

namespace marrow {
namespace {

// In half sides, by which a cell is asked behind a crossing that does not count, and the side is asked before it is
// entered: surface that lies in the border of two cells is met by one of them. A few of the shortest gaps at the
// distances that cells have from skeletons.
constexpr float behind_crossing = 2 * shortest_gap;
constexpr double before_entry = 8.0 * shortest_gap;

}  // namespace

std::optional<Box3> BlendTracer::cell_box(const TracePart& part) {
  if (part.within == nullptr || !part.within->content().is_cell(part.slot)) return {};
  return CellTree::cell(*part.within, part.slot).box();
}

std::optional<CellHit> BlendTracer::first_crossing(const TracePart& part, const Ray& ray, const CrossingFilter& filter,
                                                   CellLog& log) const {
  const Tile& tile = part.within == nullptr ? state_->tree.tile(part.tile) : *part.within;
  const auto stretch = part.within == nullptr ? stretch_in(tile, ray, false) : stretch_in(tile, part.slot, ray, false);
  if (!stretch) return {};
  log.enter = stretch->enter;
  if (part.within != nullptr && tile.content().is_cell(part.slot))
    return crossing_in(tile, part.slot, ray, stretch->enter, stretch->exit, filter, log);
  CellWalk walk;
  walk.start(state_->tree, state_->kernels, part.within == nullptr ? tile : state_->tree.child(tile, part.slot), ray,
             stretch->enter, stretch->exit);
  for (CellStep step; walk.next(step) && step.enter <= ray.t_max;)
    if (const auto hit = crossing_in(*step.tile, step.slot, ray, step.enter, step.exit, filter, log)) return hit;
  return {};
}

std::optional<CellHit> BlendTracer::crossing_in(const Tile& tile, int slot, const Ray& ray, double enter, double exit,
                                                const CrossingFilter& filter, CellLog& log) const {
  const auto all_count = filter.counts_in(CellTree::cell(tile, slot).box());
  if (!all_count.value_or(true)) return {};
  const auto counts = [&](double t) { return all_count.has_value() || filter.counts_at(t); };
  const Block* searchable = block_to_search(tile, slot);
  if (searchable == nullptr) return {};
  const Block& b = *searchable;
  const RayInCube cube(ray, b.center(), b.half());
  BlockKernels::Query query{.t0 = cube.to_local(enter),
                            .t1 = cube.to_local(exit),
                            .any = false,
                            .from_surface = enter <= ray.t_min,
                            .around = ray.around};
  const auto behind_entry = [&](float t) { return std::max(cube.to_world(t), enter); };
  const auto searched = [&] {
    const Root root = state_->kernels.first_root(b.view(), cube.local, query);
    log.add({behind_entry(root.searched_from), static_cast<std::uint32_t>(root.evaluations)});
    return root;
  };
  while (query.t0 < query.t1) {
    Root root = searched();
    if (root.enters_inside && is_inside(ray.at(std::max(ray.t_min, enter - before_entry * b.half())))) {
      query.leaving = true;
      root = searched();
    }
    if (const double t = behind_entry(root.undecided); t < log.undecided && counts(t)) log.undecided = t;
    if (!root.hit) return {};
    const double t = behind_entry(root.t);
    if (t > ray.t_max) return {};
    if (counts(t)) return CellHit{t, &b};
    query = {.t0 = std::max(root.t, query.t0) + behind_crossing,
             .t1 = query.t1,
             .any = false,
             .from_surface = query.leaving,
             .from_outside = query.leaving,
             .leaving = !query.leaving};
  }
  return {};
}

}  // namespace marrow
