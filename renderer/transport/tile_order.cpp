// The film cut into tiles.
#include "renderer/transport/tile_order.h"

#include <algorithm>
#include <cstdint>

namespace marrow {
namespace {

// Bit i goes to bit 2i.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 16) & 0x0000ffff0000ffffu;
  x = (x | x << 8) & 0x00ff00ff00ff00ffu;
  x = (x | x << 4) & 0x0f0f0f0f0f0f0f0fu;
  x = (x | x << 2) & 0x3333333333333333u;
  return (x | x << 1) & 0x5555555555555555u;
}

std::uint64_t morton(const PixelWindow& tile) {
  return spread_bits(static_cast<std::uint64_t>(tile.x0)) | spread_bits(static_cast<std::uint64_t>(tile.y0)) << 1;
}

}  // namespace

std::vector<PixelWindow> tiles_of(const PixelWindow& window, int size) {
  std::vector<PixelWindow> tiles;
  for (int y = window.y0; y < window.y1; y += size)
    for (int x = window.x0; x < window.x1; x += size)
      tiles.push_back({x, y, std::min(x + size, window.x1), std::min(y + size, window.y1)});
  std::ranges::sort(tiles, {}, morton);
  return tiles;
}

}  // namespace marrow
