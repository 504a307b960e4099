// The boxes in which surface of a tile can be, by octants of octants: what a ray is tested against first.
#pragma once

#include "field/trace/block_kernels.h"
#include "field/trace/lazy.h"
#include "field/trace/tile.h"

namespace marrow {

/// In coordinates of the tile. Boxes of neighbours overlap by far more than the rounding of rays in float.
class TileBoxes {
 public:
  TileBoxes(const TilePlace&, const TileContent&);

  const OctantBoxes& octants() const { return octants_; }
  /// Of the slots in an octant; `cell_box(slot)` gives the box around the surface in a cell, in world coordinates.
  template <class CellBox>
  const OctantBoxes& slots(int octant, const CellBox& cell_box) const {
    return slots_[octant].get([&] {
      auto boxes = std::make_unique<OctantBoxes>();
      for (int inner = 0; inner < 8; ++inner) {
        const int slot = slot_at({octant, inner});
        Box3 box;
        if (content_.cells >> slot & 1) box = cell_box(slot);
        else if (content_.tiles >> slot & 1) box = slot_box(slot);
        include(box, inner, *boxes);
      }
      return boxes;
    });
  }

 private:
  Box3 slot_box(int slot) const;
  void include(const Box3&, int octant, OctantBoxes&) const;

  const TilePlace& place_;
  TileContent content_;
  OctantBoxes octants_;
  Lazy<OctantBoxes> slots_[8];
};

}  // namespace marrow
