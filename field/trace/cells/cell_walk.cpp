#include "field/trace/cells/cell_walk.h"

#include <algorithm>

namespace marrow {

void CellWalk::start(const CellTree& tree, const BlockKernels& kernels, const Tile& tile, const Ray& ray, double enter,
                     double exit) {
  tree_ = &tree;
  kernels_ = &kernels;
  ray_ = ray;
  depth_ = 0;
  push(tile, enter, exit);
}

void CellWalk::push(const Tile& tile, double enter, double exit) {
  Level& level = levels_[depth_++];
  level.tile = &tile;
  level.cube = RayInCube(ray_, tile.place().center, tile.place().half);
  level.at = 0;
  level.first = level.cube.to_local(enter);
  level.enter = enter;
  level.exit = exit;
  kernels_->walk(tile.occupied(), level.cube.local, level.first, level.cube.to_local(exit), level.walk);
}

// The slots of an octant that is one cell follow each other along the ray: they count as one.
bool CellWalk::next(CellStep& step) {
  while (depth_ > 0) {
    Level& level = levels_[depth_ - 1];
    const Walk& walk = level.walk;
    if (level.at == walk.count) {
      --depth_;
      continue;
    }
    const TileContent& content = level.tile->content();
    const auto holder = [&](int i) {
      const int octant = path_of(walk.slot[i]).outer;
      return content.large_cells >> octant & 1 ? slot_at({octant, 0}) : walk.slot[i];
    };
    int i = level.at;
    step.tile = level.tile;
    step.slot = holder(i);
    // Exactly where the ray comes in, not that place as a float: a ray that begins here must be known to.
    step.enter = walk.begin[i] <= level.first ? level.enter : std::max(level.enter, level.cube.to_world(walk.begin[i]));
    while (i + 1 < walk.count && holder(i + 1) == step.slot) ++i;
    step.exit = std::min(level.exit, level.cube.to_world(walk.end[i]));
    level.at = i + 1;
    if (content.is_cell(step.slot)) return true;
    push(tree_->child(*level.tile, step.slot), step.enter, step.exit);
  }
  return false;
}

}  // namespace marrow
