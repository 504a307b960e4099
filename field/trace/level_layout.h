// One level of a block before and after it is laid out for the kernels.
#pragma once

#include <cstddef>
#include <functional>

#include "field/trace/block_kernels.h"
#include "field/trace/far_field.h"
#include "field/trace/source_groups.h"

namespace marrow {

/// Room for so many floats, 64-byte aligned.
using Allocate = std::function<float*(std::size_t)>;

/// Its polynomials count up to far_degree.
struct Level {
  SourceGroups curves, points;
  FarField far;
  int far_degree;

  std::size_t source_floats() const {
    return static_cast<std::size_t>((curves.group_count() + points.group_count()) * floats_per_group);
  }
  std::size_t floats() const { return source_floats() + 4 * monomials_to_degree(far_degree); }
};

/// Leaves only the monomials up to a degree, and counts the others as errors.
void truncate(FarField&, int degree);

/// Writes Level::floats() numbers from `sources` on, which is 64-byte aligned. The errors of the result are left at 0.
FieldLevel write_field(const Level&, float* sources);

}  // namespace marrow
