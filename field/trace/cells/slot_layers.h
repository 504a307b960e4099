// Which layers of a tile's slots a cell takes.
#pragma once

#include "field/trace/cells/tile.h"

namespace marrow {

/// The planes around the four layers along an axis, in coordinates of the tile: the numbers of kernels/walk.h. The
/// outer ones reach beyond the tile.
inline constexpr float slot_planes[5] = {-2, -0.5F, 0, 0.5F, 2};

/// One layer, or both of an octant.
struct LayerSpan {
  int first, end;
};

inline LayerSpan layers_of(const TileContent& content, int slot, int axis) {
  const int layer = slot >> (2 * axis) & 3;
  if (content.large_cells >> path_of(slot).outer & 1) return {layer & 2, (layer & 2) + 2};
  return {layer, layer + 1};
}

}  // namespace marrow
