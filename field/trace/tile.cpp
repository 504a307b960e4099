#include "field/trace/tile.h"

#include <utility>

#include "field/trace/block.h"
#include "field/trace/tile_boxes.h"

namespace marrow {

Tile::Tile(const TilePlace& place, Surroundings coarse, const TileContent& content)
    : place_(place),
      content_(content),
      coarse_(std::move(coarse)),
      boxes_(std::make_unique<const TileBoxes>(place_, content_)),
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
