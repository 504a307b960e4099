// One level of a block before and after it is laid out for the kernels.
#pragma once

#include <cstddef>
#include <functional>

#include "field/trace/kernels/block_kernels.h"
#include "field/trace/levels/level_polynomials.h"
#include "field/trace/sources/source_groups.h"

namespace marrow {

/// Room for so many floats, 64-byte aligned.
using Allocate = std::function<float*(std::size_t)>;

/// That write_sources() takes.
inline std::size_t source_floats(const SourceGroups& curves, const SourceGroups& points) {
  return static_cast<std::size_t>((curves.group_count() + points.group_count()) * floats_per_group);
}

/// In the coordinates of its block.
struct Level {
  SourceGroups curves, points;
  LevelPolynomials far;

  std::size_t floats() const { return source_floats(curves, points) + 4 * far.coefficients.size(); }
};

/// Writes Level::floats() numbers from `sources` on, which is 64-byte aligned. The errors of the result are left at 0.
FieldLevel write_field(const Level&, float* sources);
/// Writes source_floats() numbers from `sources` on; the result has no far field.
FieldLevel write_sources(const SourceGroups& curves, const SourceGroups& points, float* sources);
/// Writes the coefficients alone, 4 for each monomial; the result has no sources.
FieldLevel write_far(const LevelPolynomials&, float* far);

}  // namespace marrow
