#include "field/trace/tile.h"

#include <utility>

#include "field/trace/block.h"

namespace marrow {

std::uint64_t TileContent::occupied() const {
  std::uint64_t slots = cells | tiles;
  for (int octant = 0; octant < 8; ++octant)
    if (large_cells >> octant & 1)
      for (int inner = 0; inner < 8; ++inner) slots |= std::uint64_t{1} << slot_at({octant, inner});
  return slots;
}

Tile::Tile(const TilePlace& place, Surroundings coarse, const TileContent& content)
    : place_(place),
      content_(content),
      coarse_(std::move(coarse)),
      blocks_(new Lazy<Block>[static_cast<std::size_t>(std::popcount(content.cells))]),
      children_(new Lazy<Tile>[static_cast<std::size_t>(std::popcount(content.tiles))]) {}

Tile::~Tile() = default;

std::size_t Tile::bytes() const {
  std::size_t sum =
      sizeof(Tile) + coarse_.near.capacity() * sizeof(SourceRef) +
      static_cast<std::size_t>(std::popcount(content_.cells) + std::popcount(content_.tiles)) * sizeof(void*);
  const auto add = [&](const Lazy<Surroundings>& lazy) {
    if (const Surroundings* s = lazy.peek()) sum += sizeof(Surroundings) + s->near.capacity() * sizeof(SourceRef);
  };
  add(fine_);
  for (const auto& octant : octants_) add(octant);
  return sum;
}

}  // namespace marrow
