// The film cut into tiles.
#pragma once

#include <vector>

#include "renderer/output/picture.h"

namespace marrow {

/// Squares of `size` pixels in Morton order, cut to the window: neighbours in the list are neighbours in the picture,
/// and so meet the same geometry.
std::vector<PixelWindow> tiles_of(const PixelWindow& window, int size);

}  // namespace marrow
