#include "field/trace/level_recipe.h"

#include <algorithm>
#include <memory>

#include "field/trace/far_field.h"

namespace marrow {
namespace {

std::size_t source_floats(const FieldLevel& level) {
  return static_cast<std::size_t>((level.curve_groups + level.point_groups) * floats_per_group);
}

std::size_t far_floats(const FieldLevel& level) { return 4 * monomials_to_degree(level.far_degree); }

}  // namespace

LevelRecipe recipe_of(const BlockLevel& level, std::span<const PieceRule> rules, const Allocate& allocate) {
  static_assert(alignof(PieceRule) <= alignof(float) && sizeof(PieceRule) % sizeof(float) == 0);
  const std::size_t far_count = far_floats(level.level);
  float* const far = allocate(far_count + rules.size_bytes() / sizeof(float));
  std::copy_n(level.level.far, far_count, far);
  auto* const kept = reinterpret_cast<PieceRule*>(far + far_count);
  std::uninitialized_copy(rules.begin(), rules.end(), kept);
  LevelRecipe recipe{.rules = {kept, rules.size()}, .level = level};
  recipe.level.level.sources = nullptr;
  recipe.level.level.far = far;
  return recipe;
}

BlockLevel level_from(const LevelRecipe& recipe, const Block::Context& context, const CellTree::Cell& cell,
                      const Allocate& allocate) {
  SourceEmitter emitter(context.cutter, context.fine, context.degree, cell.center, cell.half);
  for (const PieceRule& rule : recipe.rules) emitter.emit_again(context.pieces[rule.piece], rule);
  BlockLevel level = recipe.level;
  const auto curve_floats = static_cast<std::size_t>(level.level.curve_groups * floats_per_group);
  float* const sources = allocate(source_floats(level.level));
  std::copy_n(emitter.curves.data(), curve_floats, sources);
  std::copy_n(emitter.points.data(), source_floats(level.level) - curve_floats, sources + curve_floats);
  level.level.sources = sources;
  return level;
}

BlockLevel copy_of(const BlockLevel& level, const Allocate& allocate) {
  const std::size_t own = source_floats(level.level);
  float* const at = allocate(own + far_floats(level.level));
  std::copy_n(level.level.sources, own, at);
  std::copy_n(level.level.far, far_floats(level.level), at + own);
  BlockLevel copy = level;
  copy.level.sources = at;
  copy.level.far = at + own;
  return copy;
}

}  // namespace marrow
