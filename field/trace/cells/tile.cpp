#include "field/trace/cells/tile.h"

#include <utility>

#include "field/trace/cells/block.h"
#include "field/trace/cells/strands.h"

namespace marrow {

std::uint64_t TileContent::slots_of_cell(int slot) const {
  const int octant = path_of(slot).outer;
  if (!(large_cells >> octant & 1)) return std::uint64_t{1} << slot;
  std::uint64_t slots = 0;
  for (int inner = 0; inner < 8; ++inner) slots |= std::uint64_t{1} << slot_at({octant, inner});
  return slots;
}

std::uint64_t TileContent::occupied() const {
  std::uint64_t slots = tiles;
  for (std::uint64_t left = cells; left != 0; left &= left - 1) slots |= slots_of_cell(std::countr_zero(left));
  return slots;
}

Tile::Tile(const TilePlace& place, KeptSurroundings coarse, const TileContent& content)
    : place_(place),
      content_(content),
      blocks_(static_cast<std::size_t>(std::popcount(content.cells)), &huge_pages()),
      occupied_(content.occupied()),
      coarse_(std::move(coarse)),
      children_(new Lazy<Tile>[static_cast<std::size_t>(std::popcount(content.tiles))]) {
  for (std::uint64_t left = content.occupied(); left != 0; left &= left - 1) {
    const Vec3d h = Vec3d{1, 1, 1} * (place.half / 4);
    const Vec3d center = slot_center(place.center, place.half, std::countr_zero(left));
    content_box_.include({center - h, center + h});
  }
}

void Tile::note_empty(int slot) const { occupied_.fetch_and(~content_.slots_of_cell(slot), std::memory_order_relaxed); }

Tile::~Tile() = default;

std::size_t Tile::bytes() const {
  std::size_t sum =
      sizeof(Tile) + coarse_.bytes() +
      static_cast<std::size_t>(std::popcount(content_.cells) + std::popcount(content_.tiles)) * sizeof(void*);
  const auto add = [&](const Lazy<KeptSurroundings>& lazy) {
    if (const KeptSurroundings* s = lazy.peek()) sum += sizeof *s + s->bytes();
  };
  add(fine_);
  if (const StrandView* s = strands_.peek())
    sum += sizeof(StrandView) + s->near.capacity() * sizeof(std::uint32_t) + s->far.capacity() * sizeof(float);
  for (const auto& octant : octants_) add(octant);
  return sum;
}

}  // namespace marrow
