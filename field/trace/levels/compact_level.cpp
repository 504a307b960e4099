#include "field/trace/levels/compact_level.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>

#include "field/trace/sources/far_field.h"
#include "field/trace/sources/quadrature.h"

namespace marrow {
namespace {

constexpr std::size_t line_floats = 16;

std::size_t whole_lines(std::size_t floats) { return (floats + line_floats - 1) / line_floats; }

std::size_t source_floats(int groups) { return static_cast<std::size_t>(groups * floats_per_group); }

std::size_t far_floats(const FieldLevel& level) { return 4 * monomials_to_degree(level.far_degree); }

int groups_of(std::span<const CurvePiece> curves) {
  int nodes = 0;
  for (const CurvePiece& piece : curves) nodes += piece.nodes;
  return (nodes + lanes - 1) / lanes;
}

}  // namespace

// What begins it, its points, its polynomials, its pieces: in the order in which they have to be aligned.
CompactLevel& write_compact(const CompactParts& parts, const Allocate& allocate) {
  static_assert(sizeof(CompactLevel) % (line_floats * sizeof(float)) == 0);
  static_assert(alignof(CurvePiece) <= alignof(float) && sizeof(CurvePiece) % sizeof(float) == 0);
  constexpr std::size_t own = sizeof(CompactLevel) / sizeof(float), piece_floats = sizeof(CurvePiece) / sizeof(float);
  const std::size_t point_floats = source_floats(parts.points.group_count());
  const std::size_t lines =
      whole_lines(own + point_floats + 4 * parts.far.coefficients.size() + piece_floats * parts.curves.size());
  float* const begin = allocate(lines * line_floats);
  float* const points = std::copy_n(parts.points.data(), point_floats, begin + own) - point_floats;
  float* const far = points + point_floats;
  auto* const level = new (begin) CompactLevel;
  level->level.level = write_far(parts.far, far);
  level->level.level.sources = points;
  level->level.level.curve_groups = groups_of(parts.curves);
  level->level.level.point_groups = parts.points.group_count();
  level->level.f_error = parts.far.f_error;
  level->level.gradient_error = parts.far.gradient_error;
  auto* const curves = reinterpret_cast<CurvePiece*>(far + 4 * parts.far.coefficients.size());
  std::uninitialized_copy(parts.curves.begin(), parts.curves.end(), curves);
  level->curves = {curves, parts.curves.size()};
  level->lines = lines;
  return *level;
}

const CompactLevel& copy_of(const CompactLevel& from, const Allocate& allocate) {
  const auto* const old = reinterpret_cast<const float*>(&from);
  float* const begin = allocate(from.lines * line_floats);
  std::memcpy(begin, &from, from.lines * line_floats * sizeof(float));
  const auto moved = [&](const float* p) { return begin + (p - old); };
  auto* const copy = new (begin) CompactLevel(from);
  copy->level.level.sources = moved(from.level.level.sources);
  copy->level.level.far = moved(from.level.level.far);
  copy->curves = {reinterpret_cast<const CurvePiece*>(moved(reinterpret_cast<const float*>(from.curves.data()))),
                  from.curves.size()};
  return *copy;
}

// The polynomials are copied, too: they are read with the sources.
BlockLevel expanded(const CompactLevel& from, const BlockKernels& kernels, const Allocate& allocate) {
  BlockLevel level = from.level;
  FieldLevel& field = level.level;
  const std::size_t curves = source_floats(field.curve_groups), points = source_floats(field.point_groups);
  float* const sources = allocate(curves + points + far_floats(field));
  kernels.write_nodes(from.curves.data(), static_cast<int>(from.curves.size()), node_table(), sources);
  float* const far = std::copy_n(field.sources, points, sources + curves);
  std::copy_n(field.far, far_floats(field), far);
  field.sources = sources;
  field.far = far;
  return level;
}

}  // namespace marrow
