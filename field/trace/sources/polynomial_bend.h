// How a polynomial bends in the cube [-1, 1]^3.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "field/trace/sources/far_field.h"

namespace marrow {

/// At least half of |second derivative| along any line, of sum c_i x^e_i over the first `count` of `monomials`;
/// coefficient(i) is c_i. Along a unit vector v it is v.A v, |A_jk| at most the sum of |second derivatives| of the
/// terms, and the largest eigenvalue of a symmetric matrix is at most its largest sum of a row, to which a term adds
/// |c| e_row (degree - 1).
template <class Coefficient>
double polynomial_bend(std::size_t count, const Coefficient& coefficient) {
  double x = 0, y = 0, z = 0;
  for (std::size_t i = 1; i < count; ++i) {
    const Monomial& m = monomials[i];
    const double c = std::fabs(static_cast<double>(coefficient(i))) * (m.degree() - 1);
    x += m.a * c;
    y += m.b * c;
    z += m.c * c;
  }
  return 0.5 * std::max({x, y, z});
}

}  // namespace marrow
