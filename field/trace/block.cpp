#include "field/trace/block.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "field/trace/block_levels.h"
#include "field/trace/level_cache.h"
#include "field/trace/level_recipe.h"
#include "field/trace/serial.h"
#include "field/trace/slot_layers.h"
#include "field/trace/stranded_level.h"

namespace marrow {
namespace {

bool holds_surface(const CubeBounds& b, const IsoCurve& iso) {
  if (static_cast<double>(b.f_low) > iso.critical_field() * 1.00001) return false;
  return b.touches || !iso.outside(0, static_cast<double>(b.f_high), static_cast<double>(b.g_high));
}

// Whether surface can be in a cube of a block, which is taken a little larger than it is, by far more than the rounding
// of rays in float.
bool may_hold(const Block::Context& context, const FieldLevel& level, const Vec3d& center, double half) {
  constexpr double overlap = 1e-4;
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

LevelCache& coarse_cache() {
  thread_local LevelCache cache;
  return cache;
}

template <class Memory>
Allocate in(Memory& memory) {
  return [&memory](std::size_t floats) { return memory.allocate(floats); };
}

}  // namespace

Block::Block(const Context& context, const CellTree::Cell& cell)
    : cell_(cell),
      view_{.find_surface = [](const void* owner,
                               int octant) { return static_cast<const Block*>(owner)->surface(octant); },
            .find_known_surface =
                [](const void* owner, std::uint64_t (&octants)[8]) {
                  return static_cast<const Block*>(owner)->known_surface(octants);
                },
            .make_coarse = [](const void* owner) -> const FieldLevel& {
              return static_cast<const Block*>(owner)->coarse().level;
            },
            .make_fine = [](const void* owner) -> const FieldLevel& {
              return static_cast<const Block*>(owner)->fine().level;
            },
            .owner = this,
            .degree = context.degree,
            .iso = context.iso.view(),
            .rows = context.iso.views().data(),
            .row_count = static_cast<int>(context.iso.views().size()),
            .tables = context.iso.tables()},
      context_(context),
      serial_(next_serial()) {
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
  // Nothing is kept of a cell that turns out to be empty, as half of them do where strands are thin.
  if (!have_recipes(context)) {
    find_octants(coarse());
  } else if (BlockArena::bytes_of_all() < context.kept_bytes) {
    thread_local LevelBuffer scratch;
    const BlockLevel made = coarse_level(context, cell, in(scratch));
    find_octants(made);
    if (octants_ != 0)
      coarse_.whole.get([&] { return std::make_unique<const BlockLevel>(copy_of(made, in(context.arena))); });
  } else {
    std::vector<PieceRule> rules;
    const BlockLevel& made = coarse_cache().get(
        serial_, [&](LevelBuffer& buffer) { return coarse_level(context, cell, in(buffer), &rules); });
    find_octants(made);
    if (octants_ != 0) keep_recipe(coarse_, made, rules);
  }
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

unsigned Block::known_surface(std::uint64_t (&octants)[8]) const {
  const unsigned known = surface_known_.load(std::memory_order_acquire) | (~octants_ & 0xff);
  for (std::size_t i = 0; i < surface_.size(); ++i)
    octants[i] = known >> i & 1 ? surface_[i].load(std::memory_order_relaxed) : 0;
  return known;
}

const SharePart& Block::part(int path) const {
  thread_local LevelCache cache;
  return patches_->at(path, context_.kernels, context_.degree, [&]() -> const BlockLevel& {
    return cache.get(serial_, [&](LevelBuffer& buffer) {
      return write_stranded_level(make_stranded_level(context_, cell_), in(buffer));
    });
  });
}

ShareAt Block::share(const Vec3d& place) const {
  int layer[3];
  for (std::size_t k = 0; k < 3; ++k) layer[k] = static_cast<int>(std::clamp(4 * place[k] + 4, 0.0, 7.5));
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

Block::Stored::Stored() = default;
Block::Stored::~Stored() = default;

// Whole as long as there is memory, then as a recipe, then not at all.
template <class Make>
const BlockLevel& Block::level(const Stored& stored, LevelCache& cache, const Make& make) const {
  if (const BlockLevel* ready = stored.whole.peek()) return *ready;
  if (BlockArena::bytes_of_all() >= context_.kept_bytes)
    return cache.get(serial_, [&](LevelBuffer& buffer) { return made_again(stored, make, buffer); });
  return stored.whole.get([&] { return std::make_unique<const BlockLevel>(make(in(context_.arena), nullptr)); });
}

template <class Make>
BlockLevel Block::made_again(const Stored& stored, const Make& make, LevelBuffer& buffer) const {
  if (const LevelRecipe* recipe = stored.recipe.peek()) return level_from(*recipe, context_, cell_, in(buffer));
  if (!have_recipes(context_)) return make(in(buffer), nullptr);
  std::vector<PieceRule> rules;
  const BlockLevel level = make(in(buffer), &rules);
  keep_recipe(stored, level, rules);
  return level;
}

void Block::keep_recipe(const Stored& stored, const BlockLevel& level, std::span<const PieceRule> rules) const {
  if (BlockArena::bytes_of_all() >= context_.kept_bytes + context_.recipe_bytes) return;
  stored.recipe.get([&] { return std::make_unique<const LevelRecipe>(recipe_of(level, rules, in(context_.arena))); });
}

const BlockLevel& Block::coarse() const {
  return level(coarse_, coarse_cache(), [&](const Allocate& allocate, std::vector<PieceRule>* rules) {
    return coarse_level(context_, cell_, allocate, rules);
  });
}

const BlockLevel& Block::fine() const {
  thread_local LevelCache cache;
  return level(fine_, cache, [&](const Allocate& allocate, std::vector<PieceRule>* rules) {
    return fine_level(context_, cell_, allocate, rules);
  });
}

}  // namespace marrow
