#include "field/trace/cells/block.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "field/base/serial.h"
#include "field/trace/cells/block_levels.h"
#include "field/trace/cells/slot_layers.h"
#include "field/trace/cells/stranded_level.h"
#include "field/trace/levels/compact_level.h"
#include "field/trace/levels/level_cache.h"

namespace marrow {
namespace {

bool holds_surface(const CubeBounds& b, const IsoCurve& iso) {
  if (static_cast<double>(b.f_low) > iso.critical_field() * 1.00001) return false;
  return b.touches || !iso.outside(0, static_cast<double>(b.f_high), static_cast<double>(b.g_high));
}

// Cubes are taken so much larger than they are, by far more than the rounding of rays in float.
constexpr double overlap = 1e-4;

// Whether surface can be in a cube of a block.
bool may_hold(const Block::Context& context, const FieldLevel& level, const Vec3d& center, double half) {
  const float c[3] = {static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z)};
  return holds_surface(context.kernels.cube_bounds(level, context.degree, c, static_cast<float>(half + overlap)),
                       context.iso);
}

// The octants of octants of an octant of a block that bounds do not prove to be outside or inside.
std::uint64_t surface_slots(const Block::Context& context, const FieldLevel& level, int octant) {
  const Vec3d whole = octant_center({0, 0, 0}, 1, octant);
  std::uint64_t slots = 0;
  for (int outer = 0; outer < 8; ++outer) {
    const Vec3d center = octant_center(whole, 0.5, outer);
    if (!may_hold(context, level, center, 0.25)) continue;
    for (int inner = 0; inner < 8; ++inner)
      if (may_hold(context, level, octant_center(center, 0.25, inner), 0.125))
        slots |= std::uint64_t{1} << slot_at({outer, inner});
  }
  return slots;
}

// From the first to the last layer along an axis in which there is any of an octant's slots; there must be some.
LayerSpan layers_with(std::uint64_t slots, int axis) {
  constexpr std::uint64_t first_layer[3] = {0x1111'1111'1111'1111, 0x000f'000f'000f'000f, 0x0000'0000'0000'ffff};
  const auto any = [&](int layer) { return (slots & first_layer[axis] << (layer << (2 * axis))) != 0; };
  LayerSpan span{0, 4};
  while (!any(span.first)) ++span.first;
  while (!any(span.end - 1)) --span.end;
  return span;
}

LevelBuffer& scratch() {
  thread_local LevelBuffer buffer;
  return buffer;
}

// Of this thread. A packet asks for fewer at a time (kernels/packet_levels.h).
using Levels = LevelCache<128>;
Levels& levels(LevelKind kind) {
  thread_local Levels coarse, fine;
  return kind == LevelKind::Coarse ? coarse : fine;
}

template <class Memory>
Allocate in(Memory& memory) {
  return [&memory](std::size_t floats) { return memory.allocate(floats); };
}

}  // namespace

Block::Block(const Context& context, const CellTree::Cell& cell)
    : cell_(cell),
      serial_(next_serial()),
      context_(context),
      view_{.find_surface = [](const void* owner,
                               int octant) { return static_cast<const Block*>(owner)->surface(octant); },
            .find_known_surface =
                [](const void* owner, std::uint64_t (&octants)[8]) {
                  return static_cast<const Block*>(owner)->known_surface(octants);
                },
            .tells_eighths = context.eighths,
            .find_eighths = [](const void* owner,
                               int slot) { return static_cast<const Block*>(owner)->find_eighths(slot); },
            .make_coarse = [](const void* owner) -> const FieldLevel& {
              return static_cast<const Block*>(owner)->coarse().level;
            },
            .make_fine = [](const void* owner) -> const FieldLevel& {
              return static_cast<const Block*>(owner)->fine().level;
            },
            .kept_level = [](const void* owner, bool fine) -> const FieldLevel* {
              const auto* const block = static_cast<const Block*>(owner);
              const BlockLevel* const kept = (fine ? block->fine_ : block->coarse_).whole.peek();
              return kept != nullptr ? &kept->level : nullptr;
            },
            .ask_for_level =
                [](const void* owner, bool fine, bool rest) {
                  const auto* const block = static_cast<const Block*>(owner);
                  block->ask_for(fine ? block->fine_ : block->coarse_, rest);
                },
            .owner = this,
            .degree = context.degree,
            .iso = context.iso.view(),
            .tables = context.iso.tables()} {
  if (context.strands != nullptr) {
    patches_ = std::make_unique<const SharePatches>();
    view_.parts = patches_->octants();
    view_.make_part = [](const void* owner, int path) -> const SharePart& {
      return static_cast<const Block*>(owner)->part(path);
    };
  }
  const auto find_octants = [&](const BlockLevel& coarse) {
    for (int octant = 0; octant < 8; ++octant)
      if (may_hold(context, coarse.level, octant_center({0, 0, 0}, 1, octant), 0.5)) octants_ |= 1U << octant;
  };
  if (have_angles()) {
    find_octants(coarse());
    make_room_for_eighths();
    return;
  }
  // Nothing is kept of a cell that turns out to be empty, as half of them do where strands are thin.
  const CompactLevel& made = compact_level(LevelKind::Coarse, context, cell, in(scratch()));
  const auto expand = [&](auto& memory) { return expanded(made, context.kernels, in(memory)); };
  find_octants(levels(LevelKind::Coarse).get(serial_, expand));
  if (octants_ == 0) return;
  make_room_for_eighths();
  if (has_room()) coarse_.whole.get([&] { return std::make_unique<const BlockLevel>(expand(context.arena)); });
  else keep(coarse_, made);
}

// Whoever asks first finds the same.
std::uint64_t Block::surface(int octant) const {
  if (!(octants_ >> octant & 1)) return 0;
  auto& slots = surface_[static_cast<std::size_t>(octant)];
  if (!(surface_known_.load(std::memory_order_acquire) >> octant & 1)) {
    slots.store(surface_slots(context_, coarse().level, octant), std::memory_order_relaxed);
    surface_known_.fetch_or(static_cast<std::uint8_t>(1U << octant), std::memory_order_release);
  }
  return slots.load(std::memory_order_relaxed);
}

void Block::make_room_for_eighths() {
  if (!context_.eighths || octants_ == 0) return;
  eighths_ = reinterpret_cast<unsigned char*>(context_.arena.allocate(slots_of_block / sizeof(float)));
  std::fill_n(eighths_, slots_of_block, static_cast<unsigned char>(unknown_eighths));
  view_.eighths = eighths_;
}

// Whoever asks first finds the same.
unsigned Block::find_eighths(int slot) const {
  const int octant = slot >> 6;
  unsigned found = 0;
  if (surface(octant) >> (slot & 63) & 1) {
    CubeBounds bounds[8];
    const Vec3d center = slot_center(octant_center({0, 0, 0}, 1, octant), 0.5, slot & 63);
    const float c[3] = {static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z)};
    context_.kernels.octant_cube_bounds(coarse().level, context_.degree, c, 0.125F, static_cast<float>(overlap),
                                        bounds);
    for (unsigned i = 0; i < 8; ++i)
      if (holds_surface(bounds[i], context_.iso)) found |= 1U << i;
    if (found == unknown_eighths) found |= 2;
  }
  std::atomic_ref(eighths_[slot]).store(static_cast<unsigned char>(found), std::memory_order_relaxed);
  return found;
}

unsigned Block::known_surface(std::uint64_t (&octants)[8]) const {
  const unsigned known = surface_known_.load(std::memory_order_acquire) | (~octants_ & 0xff);
  for (std::size_t i = 0; i < surface_.size(); ++i)
    octants[i] = known >> i & 1 ? surface_[i].load(std::memory_order_relaxed) : 0;
  return known;
}

const SharePart& Block::part(int path) const {
  // 1024 levels of w2 (34 strands, 684 lanes of sources: eight numbers each, and 40 a strand) take 31 MiB; with
  // most_strands as long they would take 440.
  constexpr std::size_t most_bytes = std::size_t{64} << 20;
  thread_local LevelCache<1024> cache(most_bytes);
  return patches_->at(path, [&](const float(&center)[3], float half, StrandShares& found) {
    const BlockLevel& strands = cache.get(serial_, [&](LevelBuffer& buffer) {
      return write_stranded_level(make_stranded_level(context_, cell_), in(buffer));
    });
    return find_shares(context_, cell_, strands, center, half, found);
  });
}

ShareAt Block::share(const Vec3d& place) const {
  int layer[3];
  constexpr double half = 0.5 * SharePart::layers;
  for (std::size_t k = 0; k < 3; ++k)
    layer[k] = static_cast<int>(std::clamp(half * place[k] + half, 0.0, SharePart::layers - 0.5));
  return share_at(SharePatches::patch_of(part(SharePatches::path_to(layer))), place);
}

Box3 Block::surface_box() const {
  Box3 box;  // in the block
  for (int octant = 0; octant < 8; ++octant) {
    if (!(octants_ >> octant & 1)) continue;
    const bool known = surface_known_.load(std::memory_order_acquire) >> octant & 1;
    const std::uint64_t slots =
        known ? surface_[static_cast<std::size_t>(octant)].load(std::memory_order_relaxed) : ~0ULL;
    if (slots == 0) continue;
    const Vec3d center = octant_center({0, 0, 0}, 1, octant);
    Box3 around;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const LayerSpan layers = layers_with(slots, axis);
      around.lower[k] = center[k] - 0.5 + 0.25 * layers.first;
      around.upper[k] = center[k] - 0.5 + 0.25 * layers.end;
    }
    box.include(around);
  }
  if (box.empty()) return {};
  constexpr double rounding = 1e-6;  // some of float's, for places and slots in the block
  return Box3{cell_.center + box.lower * cell_.half, cell_.center + box.upper * cell_.half}.padded(rounding *
                                                                                                   cell_.half);
}

const BlockLevel& Block::level(LevelKind kind, const Stored& stored) const {
  if (const BlockLevel* ready = stored.whole.peek()) return *ready;
  if (!has_room())
    return levels(kind).get(serial_, [&](LevelBuffer& buffer) { return made_again(kind, stored, in(buffer)); });
  return stored.whole.get(
      [&] { return std::make_unique<const BlockLevel>(made_again(kind, stored, in(context_.arena))); });
}

BlockLevel Block::made_again(LevelKind kind, const Stored& stored, const Allocate& allocate) const {
  if (const CompactLevel* kept = stored.compact.load(std::memory_order_acquire))
    return expanded(*kept, context_.kernels, allocate);
  if (have_angles()) return level_with_angles(kind, context_, cell_, allocate);
  const CompactLevel& made = compact_level(kind, context_, cell_, in(scratch()));
  if (!has_room()) keep(stored, made);
  return expanded(made, context_.kernels, allocate);
}

// Two threads may both have made it; the arena has room for the one that nobody finds.
void Block::keep(const Stored& stored, const CompactLevel& made) const {
  if (!has_compact_room()) return;
  const CompactLevel* before = nullptr;
  stored.compact.compare_exchange_strong(before, &copy_of(made, in(context_.arena)), std::memory_order_acq_rel);
}

const BlockLevel& Block::coarse() const { return level(LevelKind::Coarse, coarse_); }
const BlockLevel& Block::fine() const { return level(LevelKind::Fine, fine_); }

const BlockLevel* Block::fine_if_kept() const {
  if (const BlockLevel* whole = fine_.whole.peek()) return whole;
  const CompactLevel* const kept = fine_.compact.load(std::memory_order_acquire);
  return kept != nullptr ? &kept->level : nullptr;
}

// Its first lines; or what they tell of.
void Block::ask_for(const Stored& stored, bool rest) const {
  constexpr std::size_t first_lines = 4;
  const CompactLevel* const kept = stored.compact.load(std::memory_order_acquire);
  if (kept == nullptr) return;
  if (!rest) return ask_for_lines<first_lines>(kept);
  for (std::size_t line = first_lines; line < kept->lines; ++line)
    ask_for_lines<1>(reinterpret_cast<const char*>(kept) + 64 * line);
}

}  // namespace marrow
