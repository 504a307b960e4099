// How finely space is divided.
#pragma once

#include <memory>

#include "field/trace/cells/ray_spacing.h"

namespace marrow {

struct CellTreeSettings {
  double cell_size = 0.5;  ///< half side of a cell over the local radius, at most
  /// A tile of the first level has 4^tile_levels cells along its side; more where tiles, in all placements, are many.
  int tile_levels = 1;
  int deepest_level = 40;  ///< halvings since the root, at most
  /// Where rays are few cells may be larger than that, up to half a tile; null: rays are many everywhere. It has a view
  /// for each placement of the blend.
  std::shared_ptr<const RaySpacing> spacing{};
};

}  // namespace marrow
