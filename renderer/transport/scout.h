// Rays that go ahead of a picture.
#pragma once

#include "renderer/transport/pixel_block.h"

namespace marrow {

/// The paths of every `step`-th pixel along both axes; those of a window of `side` x `side` pixels go together.
struct ScoutRound {
  int step, side;
};

/// Few paths first, so that most meet surfaces that are already divided for rays like them; and in so many windows that
/// threads end together, as the first divide space.
inline constexpr ScoutRound scout_rounds[] = {{32, 256}, {8, 128}};

/// The paths of every `step`-th pixel of the window along both axes, which leave nothing in the picture but surfaces
/// that know where rays go: Surfaces::refine() makes use of it.
void send_scouts(const PixelJob&, const PixelWindow& window, int step);

}  // namespace marrow
