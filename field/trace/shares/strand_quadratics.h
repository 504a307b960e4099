// Quadratics in a cube, fitted to values at its strand_place.
//
// Coordinates are the cube's own, [-1, 1]^3; a row of `width` numbers goes with each place, and with each of
// quadratic_monomials, and column by column they are quadratics of their own.
#pragma once

#include <cstddef>

#include "field/math/vec3.h"
#include "field/trace/kernels/block_view.h"

namespace marrow {

/// Least squares, all places alike: writes `coefficients`, a row for each monomial, from `values`, one for each place.
void fit_quadratics(const float* values, std::size_t width, float* coefficients);

/// Adds the quadratics at x to `sums`, `width` of them.
void add_quadratics(const float* coefficients, std::size_t width, const Vec3d& x, float* sums);

}  // namespace marrow
