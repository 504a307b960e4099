// What Taylor polynomials of inverse powers leave out.
#pragma once

namespace marrow {

/// psi_P^n(q) = (1-q)^-n - sum_{k<=P} binom(n+k-1,k) q^k: the remainder of the Taylor series of degree P of
/// d^-n over a ball of radius q d, relative to d^-n. 0 <= q < 1; summed without cancellation.
/// The k-th derivative of d^-n has a norm of n (n+1) ... (n+k-1) d^-(n+k), since Gegenbauer polynomials are largest
/// at 1. psi_P / q^(P+1) rises, so that the nearest source decides: with d the least distance, |v| = q d, and
/// M2 = sum w d_i^-(n+2), M3 = sum w tau d_i^-(n+3) over the sources of f = sum w d_i^-n and G = grad sum w tau d_i^-n
///   |f(p + v) - f - grad f . v| <= M2 d^2 psi_1^n(q),   |G(p + v) - G - H v| <= n M3 d^2 psi_1^(n+1)(q).
/// These hold for positive weights, and so for integrals, and all along a ray.
double taylor_remainder(int exponent, int degree, double q);

}  // namespace marrow
