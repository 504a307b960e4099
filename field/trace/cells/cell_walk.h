// The cells that a ray comes through in a tile, nearest first.
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "field/math/ray.h"
#include "field/trace/cells/cell_tree.h"
#include "field/trace/cells/ray_in_cube.h"
#include "field/trace/kernels/block_kernels.h"

namespace marrow {

/// Where a ray is in the box around all that a tile of the first level holds; of one that is to meet `any` surface, to
/// just behind its end. Empty: it is not.
inline std::pair<double, double> clip_to_tile(const Tile& tile, const Ray& ray, bool any) {
  const Vec3d& direction = ray.direction;
  auto [enter, exit] = clip(tile.content_box(), ray, {1 / direction.x, 1 / direction.y, 1 / direction.z});
  return {enter, any ? std::min(exit, ray.t_max + nearly_ended * tile.place().half) : exit};
}

/// A cell of a tile, and where the ray is in it.
struct CellStep {
  const Tile* tile = nullptr;
  int slot = 0;
  double enter = 0, exit = 0;

  bool is_cell_of(const CellStep& other) const { return tile == other.tile && slot == other.slot; }
};

using CellSteps = std::array<CellStep, packet_size>;

/// Smaller tiles are divided when the ray comes to them.
class CellWalk {
 public:
  CellWalk() = default;

  /// Through a tile of the first level, from `enter` to `exit`.
  void start(const CellTree&, const BlockKernels&, const Tile&, const Ray&, double enter, double exit);
  /// False when there are no more.
  bool next(CellStep&);

 private:
  // One of the tiles around a cell.
  struct Level {
    const Tile* tile;
    RayInCube cube;
    Walk walk;
    int at;  // the next slot of the walk
    float first;
    double enter, exit;
  };
  void push(const Tile&, double enter, double exit);

  const CellTree* tree_ = nullptr;
  const BlockKernels* kernels_ = nullptr;
  Ray ray_;
  std::size_t depth_ = 0;
  std::array<Level, CellPlace::most_tiles> levels_;
};

}  // namespace marrow
