#include "field/math/taylor_remainder.h"

#include <cmath>

namespace marrow {

// The tail sum_{k>P} binom(n+k-1,k) q^k has growing ratio (n+k)/(k+1) q < 1 from some k on; it is summed
// until a geometric bound of the rest is below 1e-3 of the sum, and the bound is added.
double taylor_remainder(int exponent, int degree, double q) {
  if (q >= 1) return HUGE_VAL;
  double term = 1;
  for (int k = 0; k <= degree; ++k) term *= q * (exponent + k) / (k + 1);
  double sum = 0;
  for (int k = degree + 1; k < 4000; ++k) {
    sum += term;
    const double ratio = q * (exponent + k) / (k + 1);
    term *= ratio;
    if (ratio < 1 && term < 1e-3 * sum * (1 - ratio)) return sum + term / (1 - ratio);
  }
  return HUGE_VAL;
}

}  // namespace marrow
