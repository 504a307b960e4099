// The boxes in which surface of a tile can be, by octants of octants: what a ray is tested against first.
#pragma once

#include <vector>

#include "field/trace/block_kernels.h"
#include "field/trace/tile.h"

namespace marrow {

/// Nodes in coordinates of the tile. An octant of a node has a node of its own (`child`), or is a slot (`polynomial`).
struct TileBoxes {
  std::vector<PatchNode> nodes;
};

/// `cell_box(slot)`: the box around the surface in a cell, in world coordinates; empty when there is none.
template <class CellBox>
TileBoxes make_tile_boxes(const TilePlace&, const TileContent&, const CellBox& cell_box);

/// A box without surface, or one with it, as octant i of a node; in coordinates of the node. Boxes of neighbours
/// overlap by far more than the rounding of rays in float.
void write_box(const Box3& box, int octant, PatchNode&);

template <class CellBox>
TileBoxes make_tile_boxes(const TilePlace& place, const TileContent& content, const CellBox& cell_box) {
  TileBoxes out;
  out.nodes.push_back({});
  const double scale = 1 / place.half;
  const auto local = [&](const Box3& box) {
    return box.empty() ? box : Box3{(box.lower - place.center) * scale, (box.upper - place.center) * scale};
  };
  for (int outer = 0; outer < 8; ++outer) {
    if (content.large_cells >> outer & 1) {
      const int slot = slot_at({outer, 0});
      write_box(local(cell_box(slot)), outer, out.nodes[0]);
      out.nodes[0].polynomial[outer] = slot;
      continue;
    }
    PatchNode node{};
    Box3 all;
    for (int inner = 0; inner < 8; ++inner) {
      const int slot = slot_at({outer, inner});
      Box3 box;
      if (content.cells >> slot & 1) box = cell_box(slot);
      else if (content.tiles >> slot & 1)
        box = TilePlace{slot_center(place.center, place.half, slot), place.half / 4}.box();
      if (!box.empty()) all.include(box);
      write_box(local(box), inner, node);
      node.polynomial[inner] = slot;
    }
    write_box(local(all), outer, out.nodes[0]);
    if (all.empty()) continue;
    out.nodes[0].child[outer] = static_cast<int>(out.nodes.size());
    out.nodes.push_back(node);
  }
  return out;
}

}  // namespace marrow
