// Rays that go ahead of a picture.
#pragma once

#include "renderer/transport/pixel_block.h"

namespace marrow {

/// Pixels between the paths of one round of scouts and the next: few of them first, so that most of them meet surfaces
/// that are already divided for rays like them.
inline constexpr int scout_steps[] = {32, 8};

/// The side of a window whose scouts go together.
constexpr int scouted_side(int step) { return 16 * step; }

/// The paths of every `step`-th pixel of the window along both axes, which leave nothing in the picture but surfaces
/// that know where rays go: Surfaces::refine() makes use of it.
void send_scouts(const PixelJob&, const PixelWindow& window, int step);

}  // namespace marrow
