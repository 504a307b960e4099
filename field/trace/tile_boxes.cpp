#include "field/trace/tile_boxes.h"

namespace marrow {

TileBoxes::TileBoxes(const TilePlace& place, const TileContent& content) : place_(place), content_(content) {
  for (int outer = 0; outer < 8; ++outer) {
    bool any = content.large_cells >> outer & 1;
    for (int inner = 0; inner < 8; ++inner)
      any = any || ((content.cells | content.tiles) >> slot_at({outer, inner}) & 1);
    if (any) include(TilePlace{octant_center(place.center, place.half, outer), place.half / 2}.box(), outer, octants_);
  }
}

Box3 TileBoxes::slot_box(int slot) const {
  return TilePlace{slot_center(place_.center, place_.half, slot), place_.half / 4}.box();
}

void TileBoxes::include(const Box3& box, int octant, OctantBoxes& out) const {
  constexpr float overlap = 2e-5F;
  if (box.empty()) return;
  const double scale = 1 / place_.half;
  for (std::size_t k = 0; k < 3; ++k) {
    out.lower[k][octant] = static_cast<float>((box.lower[k] - place_.center[k]) * scale) - overlap;
    out.upper[k][octant] = static_cast<float>((box.upper[k] - place_.center[k]) * scale) + overlap;
  }
  out.present |= 1U << octant;
}

}  // namespace marrow
