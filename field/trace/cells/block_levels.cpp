#include "field/trace/cells/block_levels.h"

#include <algorithm>
#include <new>
#include <span>
#include <utility>

#include "field/trace/cells/precision.h"
#include "field/trace/sources/source_emitter.h"

namespace marrow {
namespace {

bool is_coarse(LevelKind kind) { return kind == LevelKind::Coarse; }
const NearFar& precision_of(LevelKind kind, const Block::Context& c) { return is_coarse(kind) ? c.coarse : c.fine; }
Economy economy_of(LevelKind kind, const Block::Context& context) {
  return is_coarse(kind) ? coarse_economy : fine_economy(context.fine);
}
Surroundings surroundings(LevelKind kind, const Block::Context& context, const CellTree::Cell& cell) {
  return is_coarse(kind) ? context.tree.coarse_surroundings(cell) : context.tree.surroundings(cell);
}

// Where no rule is certified, beside the point of a cone, an error may be infinite.
float counted(LevelKind kind, double error) { return static_cast<float>(is_coarse(kind) ? 1.0001 * error : 0); }

void count_errors(LevelKind kind, BlockLevel& level) {
  level.level.f_error = counted(kind, level.f_error);
  level.level.g_error = counted(kind, level.gradient_error);
}

void add_errors(const RuleFinder& rules, LevelPolynomials& far) {
  far.f_error += rules.f_error;
  far.gradient_error += rules.gradient_error;
}

Level make_level(LevelKind kind, const Block::Context& context, std::span<const Piece> pieces,
                 const Surroundings& around, const CellTree::Cell& cell) {
  SourceEmitter emitter(context.cutter, precision_of(kind, context), cell.center, cell.half);
  for (const SourceRef ref : around.near) emitter.emit(pieces[ref.index()]);
  Level level{std::move(emitter.curves), std::move(emitter.points), economized(around.far, economy_of(kind, context))};
  add_errors(emitter.rules, level.far);
  return level;
}

// The field of angles, at the same errors, from its own tree.
Level make_angle_level(LevelKind kind, const Block::Context& context, const CellTree::Cell& cell) {
  Surroundings s;
  s.near = precision_of(kind, context)
               .split(*context.angle, context.angle->roots(), cell.center, cell.half, NearFar::open_all, s.far);
  return make_level(kind, context, context.angle->pieces(), s, cell);
}

}  // namespace

const CompactLevel& compact_level(LevelKind kind, const Block::Context& context, const CellTree::Cell& cell,
                                  const Allocate& allocate) {
  const Surroundings around = surroundings(kind, context, cell);
  CompactParts parts{.curves = {}, .points = {}, .far = economized(around.far, economy_of(kind, context))};
  RuleFinder rules(context.cutter, precision_of(kind, context), cell.center, cell.half);
  for (const SourceRef ref : around.near) {
    const Piece& piece = context.pieces[ref.index()];
    if (piece.is_point()) {
      add_nodes(piece, 1, cell.center, cell.half, context.degree, parts.points);
      continue;
    }
    rules.find(piece, 1, [&](const Piece& part, int nodes) {
      parts.curves.push_back(curve_piece(part, nodes, cell.center, cell.half, context.degree));
    });
  }
  // Rules of the same size follow each other, so that processors foresee where groups of nodes are full.
  std::stable_sort(parts.curves.begin(), parts.curves.end(),
                   [](const CurvePiece& a, const CurvePiece& b) { return a.nodes > b.nodes; });
  add_errors(rules, parts.far);
  CompactLevel& made = write_compact(parts, allocate);
  count_errors(kind, made.level);
  return made;
}

// In one piece of memory: the level, then the field of angles, then what refers to it.
BlockLevel level_with_angles(LevelKind kind, const Block::Context& context, const CellTree::Cell& cell,
                             const Allocate& allocate) {
  const Level level = make_level(kind, context, context.pieces, surroundings(kind, context, cell), cell),
              angle = make_angle_level(kind, context, cell);
  const auto floats_of = [](const Level& l) { return (l.floats() + lanes - 1) / lanes * lanes; };
  constexpr std::size_t reference_floats = (sizeof(FieldLevel) + sizeof(float) - 1) / sizeof(float);
  const std::size_t own = floats_of(level), second = floats_of(angle);
  float* const at = allocate(own + second + reference_floats);
  BlockLevel out;
  out.level = write_field(level, at);
  out.f_error = level.far.f_error;
  out.gradient_error = level.far.gradient_error;
  out.angle_error = angle.far.f_error;
  count_errors(kind, out);
  auto* const reference = new (at + own + second) FieldLevel(write_field(angle, at + own));
  reference->f_error = counted(kind, angle.far.f_error);
  out.level.angle = reference;
  return out;
}

}  // namespace marrow
