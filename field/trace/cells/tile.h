// A cube of 4 x 4 x 4 slots: what of the space of a blend is divided at once, when the first ray comes by.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "field/base/ask_for.h"
#include "field/base/huge_pages.h"
#include "field/base/lazy.h"
#include "field/math/box3.h"
#include "field/trace/cells/divider.h"

namespace marrow {

class Block;
struct StrandView;
struct UpperCube;

/// Where a tile is and what it belongs to.
struct TilePlace {
  Vec3d center;
  double half = 0;
  int level = 0;                       ///< halvings since the root
  int slot = 0;                        ///< in the parent; of a tile of the first level its octant of `above`
  const class Tile* parent = nullptr;  ///< null: a tile of the first level
  const UpperCube* above = nullptr;    ///< of a tile of the first level

  Box3 box() const {
    const Vec3d h{half, half, half};
    return {center - h, center + h};
  }
};

/// What a tile is divided into. A slot, x + 4 y + 16 z, holds nothing, a cell, or a smaller tile; or the eight slots of
/// an octant are one cell, which goes by the first of them.
struct TileContent {
  std::uint64_t cells = 0, tiles = 0;  ///< a bit for each slot
  std::uint8_t large_cells = 0;        ///< a bit for each octant that is one cell

  /// All slots that hold something.
  std::uint64_t occupied() const;
  bool is_cell(int slot) const { return cells >> slot & 1; }
  /// The slots of the cell that goes by this one.
  std::uint64_t slots_of_cell(int slot) const;
};

/// Blocks of cells and smaller tiles are made when asked for.
class alignas(64) Tile : public InHugePages {
 public:
  /// `coarse`: the sources around it, as the divider sees them.
  Tile(const TilePlace&, KeptSurroundings coarse, const TileContent&);
  ~Tile();

  const TilePlace& place() const { return place_; }
  const TileContent& content() const { return content_; }
  /// The slots that hold something, less those noted as empty.
  std::uint64_t occupied() const { return occupied_.load(std::memory_order_relaxed); }
  /// A block has been found to hold no surface: rays need not ask for it again.
  void note_empty(int slot) const;
  /// Around all that the tile holds.
  const Box3& content_box() const { return content_box_; }
  const KeptSurroundings& coarse() const { return coarse_; }
  const Lazy<KeptSurroundings>& fine() const { return fine_; }
  const Lazy<KeptSurroundings>& fine_of_octant(int octant) const { return octants_[static_cast<std::size_t>(octant)]; }
  /// Made by Strands.
  const Lazy<StrandView>& strands() const { return strands_; }
  /// Of a slot that has one.
  const Lazy<Block>& block(int slot) const { return blocks_[rank(content_.cells, slot)]; }
  /// Asks memory for what rays need on their way to a cell.
  void ask_for() const { ask_for_lines<2>(this); }
  const Lazy<Tile>& child(int slot) const { return children_[rank(content_.tiles, slot)]; }
  /// Of this tile itself, without its blocks and smaller tiles.
  std::size_t bytes() const;

 private:
  static std::size_t rank(std::uint64_t mask, int slot) {
    return static_cast<std::size_t>(std::popcount(mask & ((std::uint64_t{1} << slot) - 1)));
  }

  // What rays need on their way to a cell comes first.
  TilePlace place_;
  TileContent content_;
  Box3 content_box_;
  std::pmr::vector<Lazy<Block>> blocks_;
  mutable std::atomic<std::uint64_t> occupied_;
  KeptSurroundings coarse_;
  Lazy<KeptSurroundings> fine_;
  std::array<Lazy<KeptSurroundings>, 8> octants_;
  Lazy<StrandView> strands_;
  std::unique_ptr<Lazy<Tile>[]> children_;
};

/// The octant of the tile in which a slot lies, and the octant of that which it is.
struct SlotPath {
  int outer, inner;
};
constexpr SlotPath path_of(int slot) {
  const int x = slot & 3, y = slot >> 2 & 3, z = slot >> 4;
  return {(x >> 1) | (y >> 1) << 1 | (z >> 1) << 2, (x & 1) | (y & 1) << 1 | (z & 1) << 2};
}
constexpr int slot_at(SlotPath p) {
  int slot = 0;
  for (int axis = 0; axis < 3; ++axis) slot |= ((p.outer >> axis & 1) << 1 | (p.inner >> axis & 1)) << (2 * axis);
  return slot;
}
inline Vec3d slot_center(const Vec3d& center, double half, int slot) {
  const SlotPath path = path_of(slot);
  return octant_center(octant_center(center, half, path.outer), half / 2, path.inner);
}

}  // namespace marrow
