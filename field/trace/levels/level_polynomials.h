// The far field of a level as the kernels evaluate it: polynomials of a lower degree than it was gathered with.
#pragma once

#include <array>
#include <vector>

#include "field/trace/sources/far_field.h"

namespace marrow {

struct LevelPolynomials {
  int degree = 0;
  std::vector<std::array<double, 4>> coefficients;  ///< of (f, Gx, Gy, Gz), G = grad_S f, for each monomial
  double f_error = 0, gradient_error = 0;           ///< as in FarField
};

/// What kernels evaluate.
inline constexpr std::array<int, 3> evaluated_degrees{2, 4, 5};

/// The highest degree, and what polynomials may leave out to be of a lower one.
struct Economy {
  int most;
  double f = 0, gradient = 0;
};

/// Chebyshev's economy [Lanczos 1956]: what is left out of x^a y^b z^c is not the monomial but the largest multiple of
/// T_a(x) T_b(y) T_c(z) in it, 2^(1-a) 2^(1-b) 2^(1-c) (1 for an exponent of 0), which is at most as large as that in
/// the cube; the rest is of lower degrees. So polynomials of degree 5 are nearly as good as those of degree 8 that they
/// come from, at a third of the cost. What is left out counts as an error. Of the evaluated degrees up to `most` the
/// lowest is taken for which that is allowed; `most` itself whatever it leaves out.
LevelPolynomials economized(const FarField&, const Economy&);

}  // namespace marrow
