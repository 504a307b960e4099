#include "field/trace/block_levels.h"

#include <new>
#include <optional>
#include <span>
#include <utility>

#include "field/trace/precision.h"
#include "field/trace/source_emitter.h"

namespace marrow {
namespace {

Level make_level(const Block::Context& context, const NearFar& precision, std::span<const Piece> pieces,
                 const Surroundings& around, const CellTree::Cell& cell, const Economy& economy,
                 std::vector<PieceRule>* rules = nullptr) {
  SourceEmitter emitter(context.cutter, precision, context.degree, cell.center, cell.half);
  for (const SourceRef ref : around.near) emitter.emit(pieces[ref.index()], ref.index(), rules);
  Level level{std::move(emitter.curves), std::move(emitter.points), economized(around.far, economy)};
  level.far.f_error += emitter.f_error;
  level.far.gradient_error += emitter.gradient_error;
  return level;
}

// The field of angles, at the same errors, from its own tree; nothing where alpha is constant.
std::optional<Level> make_angle_level(const Block::Context& context, const NearFar& precision,
                                      const CellTree::Cell& cell, const Economy& economy) {
  if (context.angle == nullptr) return {};
  constexpr double open_all = NearFar::open_all;
  Surroundings s;
  s.near = precision.split(*context.angle, context.angle->roots(), cell.center, cell.half, open_all, s.far);
  return make_level(context, precision, context.angle->pieces(), s, cell, economy);
}

// Whether the errors count wherever "outside" is to be proved, or are only stated.
enum class Errors { Counted, Stated };

// In one piece of memory: the level, then the field of angles, then what refers to it.
BlockLevel write_level(const Level& level, const std::optional<Level>& angle, Errors errors, const Allocate& allocate) {
  const auto floats_of = [](const Level& l) { return (l.floats() + lanes - 1) / lanes * lanes; };
  constexpr std::size_t reference_floats = (sizeof(FieldLevel) + sizeof(float) - 1) / sizeof(float);
  const std::size_t own = floats_of(level), second = angle ? floats_of(*angle) : 0;
  float* const at = allocate(own + second + (angle ? reference_floats : 0));
  // Where no rule is certified, beside the point of a cone, an error may be infinite.
  const auto counted = [errors](double error) {
    return static_cast<float>(errors == Errors::Counted ? 1.0001 * error : 0);
  };
  BlockLevel out;
  out.level = write_field(level, at);
  out.f_error = level.far.f_error;
  out.gradient_error = level.far.gradient_error;
  out.level.f_error = counted(out.f_error);
  out.level.g_error = counted(out.gradient_error);
  if (angle) {
    auto* const reference = new (at + own + second) FieldLevel(write_field(*angle, at + own));
    out.angle_error = angle->far.f_error;
    reference->f_error = counted(out.angle_error);
    out.level.angle = reference;
  }
  return out;
}

}  // namespace

BlockLevel coarse_level(const Block::Context& context, const CellTree::Cell& cell, const Allocate& allocate,
                        std::vector<PieceRule>* rules) {
  const NearFar& coarse = context.coarse;
  const Surroundings around = context.tree.coarse_surroundings(cell);
  return write_level(make_level(context, coarse, context.pieces, around, cell, coarse_economy, rules),
                     make_angle_level(context, coarse, cell, coarse_economy), Errors::Counted, allocate);
}

BlockLevel fine_level(const Block::Context& context, const CellTree::Cell& cell, const Allocate& allocate,
                      std::vector<PieceRule>* rules) {
  const NearFar& fine = context.fine;
  const Surroundings around = context.tree.surroundings(cell);
  return write_level(make_level(context, fine, context.pieces, around, cell, fine_economy(fine), rules),
                     make_angle_level(context, fine, cell, fine_economy(fine)), Errors::Stated, allocate);
}

}  // namespace marrow
