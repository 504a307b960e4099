#include "field/trace/tile_boxes.h"

namespace marrow {

void write_box(const Box3& box, int octant, PatchNode& node) {
  constexpr float overlap = 2e-5F;
  const bool none = box.empty();
  for (std::size_t k = 0; k < 3; ++k) {
    node.lower[k][octant] = none ? 0 : static_cast<float>(box.lower[k]) - overlap;
    node.upper[k][octant] = none ? 0 : static_cast<float>(box.upper[k]) + overlap;
  }
  node.offset[octant] = none ? -1e30F : 1e30F;
}

}  // namespace marrow
