// The far field of a level as the kernels evaluate it: polynomials of a lower degree than it was gathered with.
#pragma once

#include <array>
#include <vector>

#include "field/trace/far_field.h"

namespace marrow {

struct LevelPolynomials {
  int degree = 0;
  std::vector<std::array<double, 4>> coefficients;  ///< of (f, Gx, Gy, Gz), G = grad_S f, for each monomial
  double f_error = 0, gradient_error = 0;           ///< as in FarField
};

/// Chebyshev's economy: what is left out of x^a y^b z^c is not the monomial but the largest multiple of
/// T_a(x) T_b(y) T_c(z) in it, 2^(1-a) 2^(1-b) 2^(1-c) (1 for an exponent of 0), which is at most as large as that in
/// the cube; the rest is of lower degrees. So polynomials of degree 4 are nearly as good as those of degree 6 that they
/// come from, at two fifths of the cost. What is left out counts as an error.
LevelPolynomials economized(const FarField&, int degree);

}  // namespace marrow
