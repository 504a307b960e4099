// What tracing needs of one cell: near sources, the far field, and where in it surface can be.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "field/base/ask_for.h"
#include "field/base/huge_pages.h"
#include "field/base/lazy.h"
#include "field/math/box3.h"
#include "field/trace/cells/block_arena.h"
#include "field/trace/cells/cell_tree.h"
#include "field/trace/kernels/block_kernels.h"
#include "field/trace/levels/block_level.h"
#include "field/trace/levels/level_layout.h"
#include "field/trace/shares/share_at.h"
#include "field/trace/shares/share_patches.h"

namespace marrow {

struct CompactLevel;
enum class LevelKind;
class Strands;

/// The field of one blend in one cell: the sources that are near, a polynomial of all others, and which parts of the
/// cell may hold surface. Coordinates of the block: x = (p - center) / half, the cell is [-1, 1]^3. Its levels are made
/// when the first ray needs them, and are functions of the cell alone; safe to use from many threads.
class alignas(64) Block : public InHugePages {
 public:
  struct Context {
    std::span<const Piece> pieces;  ///< in the order of the source tree
    const CellTree& tree;
    const PieceCutter& cutter;
    const NearFar& coarse;  ///< errors of the coarse level
    const NearFar& fine;    ///< errors of the fine level
    const IsoCurve& iso;
    const BlockKernels& kernels;
    int degree;
    BlockArena& arena;                  ///< holds what blocks are made of
    std::size_t kept_bytes;             ///< see TraceOptions
    const SourceTree* angle = nullptr;  ///< of angle_field.h, where skeletons have an angle each
    const Strands* strands = nullptr;   ///< where their directions give the angle
    std::size_t compact_bytes = 0;      ///< see TraceOptions
    bool eighths = true;                ///< slots tell which of their eighths may hold surface
  };
  /// The context must outlive the block.
  Block(const Context&, const CellTree::Cell&);
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  const BlockView& view() const { return view_; }
  /// Asks memory for what rays need of it first.
  void ask_for() const { ask_for_lines<3>(this); }
  /// No octant can hold surface.
  bool empty() const { return octants_ == 0; }
  /// Around all slots that may hold surface, as far as they are known by now; a little larger, for what rounding does
  /// to rays. Empty when there are none.
  Box3 surface_box() const;
  const Context& context() const { return context_; }
  const Vec3d& center() const { return cell_.center; }
  double half() const { return cell_.half; }

  /// Kept as long as the levels of all blends fit into a certain memory; else good until this thread asks another block
  /// for the same one. They are the same in either case.
  const BlockLevel& coarse() const;
  const BlockLevel& fine() const;
  /// What is kept of it, perhaps without sources; null if nothing is.
  const BlockLevel* fine_if_kept() const;
  /// Where directions give the angle, else null.
  const SharePatches* patches() const { return patches_.get(); }
  /// The share of the range of angles at a place of the block, where directions give it.
  ShareAt share(const Vec3d& place) const;

 private:
  // One of the two levels: whole as long as there is memory, then as what it is made of, then not at all.
  struct Stored {
    Lazy<BlockLevel> whole;
    mutable std::atomic<const CompactLevel*> compact = nullptr;  // in the arena
  };
  bool have_angles() const { return context_.angle != nullptr; }
  bool has_room() const { return BlockArena::bytes_of_all() < context_.kept_bytes; }
  bool has_compact_room() const { return BlockArena::bytes_of_all() < context_.compact_bytes; }
  const BlockLevel& level(LevelKind, const Stored&) const;
  BlockLevel made_again(LevelKind, const Stored&, const Allocate&) const;
  void keep(const Stored&, const CompactLevel&) const;
  void ask_for(const Stored&, bool rest) const;
  std::uint64_t surface(int octant) const;
  unsigned known_surface(std::uint64_t (&octants)[8]) const;
  void make_room_for_eighths();
  unsigned find_eighths(int slot) const;
  const SharePart& part(int path) const;

  // What each ray needs comes first, in three cache lines; of the view that is what makes the levels.
  CellTree::Cell cell_;
  unsigned octants_ = 0;                                 // a bit for each that may hold surface
  mutable std::atomic<std::uint8_t> surface_known_ = 0;  // a bit for each octant
  Stored coarse_, fine_;
  std::uint64_t serial_;
  const Context& context_;
  mutable std::array<std::atomic<std::uint64_t>, 8> surface_{};
  unsigned char* eighths_ = nullptr;  // BlockView's, in the arena
  BlockView view_;
  std::unique_ptr<const SharePatches> patches_;
};

}  // namespace marrow
