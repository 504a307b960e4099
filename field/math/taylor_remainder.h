// What Taylor polynomials of inverse powers leave out.
#pragma once

namespace marrow {

/// psi_P^n(q) = (1-q)^-n - sum_{k<=P} binom(n+k-1,k) q^k: the remainder of the Taylor series of degree P of
/// d^-n over a ball of radius q d, relative to d^-n (tracing.md B5). 0 <= q < 1; summed without cancellation.
double taylor_remainder(int exponent, int degree, double q);

}  // namespace marrow
