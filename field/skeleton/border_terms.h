// What a place on the border of a plate adds to integrals of powers of the distance over it; internal to skeleton/.
#pragma once

#include <cmath>
#include <span>

#include "field/math/elementary.h"

namespace marrow {

// In polar coordinates about the foot the integral over the distance from it is (h^-q - d^-q) / q, h the height of the
// point, q = m - 2 > 0, and d taken on the border, so that the integral of d^-m over the plate is
//   1/q sum over sides of e int (h^-q - d^-q) / (t^2 + e^2) dt, with e for `inside`.   [plate.h]
// Both functions leave out the 1/q and add what is left: of q to the first sum, of q + 2, q + 4, ... to those after it.

/// From the foot, over h^-q: the fraction is h^-q d^-2 (1 - x^(q/2)) / (1 - x), x = h^2 / d^2, a sum of powers of x,
/// all positive. `factor` is e d^-2 dt.
inline void add_terms_from_foot(double x, double factor, int q, std::span<double> sums) {
  double powers = 0, last = 1;
  for (int k = 0; k < q / 2; ++k, last *= x) powers += last;
  const double half = q % 2 == 0 ? 0 : 1 / (1 + std::sqrt(x));  // of an odd q: (1 - x^(1/2)) / (1 - x)
  for (double& sum : sums) {
    sum += factor * (powers + last * half);
    powers += last;
    last *= x;
  }
}

/// Without h^-q, which adds up to nothing where the foot is outside. `inverse` is d^-2, `factor` e / (t^2 + e^2) dt.
inline void add_terms_of_border(double inverse, double factor, int q, std::span<double> sums) {
  double power = half_power(inverse, q) * factor;
  for (double& sum : sums) {
    sum -= power;
    power *= inverse;
  }
}

}  // namespace marrow
