// What lies far from a cube, as Taylor polynomials about its centre: the field f (degree 4), and the
// potential F with grad F = grad_S f (degree 5, so that grad_S f has degree 4 too).
//
// Coordinates are the cube's own: x = (p - centre) / half, so the cube is [-1, 1]^3. All lengths that
// enter (radii, source positions) are in these units; f is dimensionless, and F here is F / half, so
// that its gradient in x is grad_S f itself.
#pragma once

#include <array>
#include <cstddef>

#include "field/math/vec3.h"

namespace marrow {

/// Monomials of degree <= k in three variables: binom(k + 3, 3).
constexpr std::size_t monomials_to_degree(int k) { return static_cast<std::size_t>((k + 1) * (k + 2) * (k + 3) / 6); }

inline constexpr int field_degree = 4, potential_degree = 5;
inline constexpr std::size_t monomial_count = monomials_to_degree(potential_degree);  // 56

/// Exponents of the monomials x^a y^b z^c, sorted by degree.
struct Monomial {
  int a, b, c;
  constexpr int degree() const { return a + b + c; }
};
extern const std::array<Monomial, monomial_count> monomials;
std::size_t monomial_index(int a, int b, int c);

using Polynomial = std::array<double, monomial_count>;

/// Turns moments of sources r about the origin into the Taylor coefficients of sum w |x - r|^-m.
/// The expansion is the Gegenbauer series, |x - r|^-m = sum_k C_k^(m/2)(cos) |x|^k |r|^-(m+k). Its terms are
/// (x.r)^k |x|^(2j) |r|^-(m+2k+2j) times a constant, so the moments needed are
///   sum w r^(tensor k) |r|^-(m+2k+2j)   for j = 0, k = 0..5;  j = 1, k = 0..3;  j = 2, k = 0, 1
/// (56 + 20 + 4 numbers), here without the constants, which are applied on the way. With y = r / |r|^2 and the field
/// f_i = w |r|^-m of a source at the origin they are sums of f_i y^(tensor k) |y|^(2j).
inline constexpr std::size_t moment_count = 56 + 20 + 4;
using Moments = std::array<float, moment_count>;
void add_moments(const Moments& f, const Moments& potential, int exponent, struct FarField&);

struct FarField {
  Polynomial f{};  ///< its coefficients of degree 5 are 0
  Polynomial potential{};
  double f_error = 0;         ///< |f - polynomial| over the cube, at most
  double gradient_error = 0;  ///< |grad_S f - gradient of polynomial| over the cube, at most

  /// The same far field in the coordinates of one of the eight half-sized cubes; `octant` has a bit for each axis.
  FarField of_child(int octant) const;

  struct Bounds {
    double f_center;
    double f_variation;  ///< |f(x) - f_center| over the cube, at most, errors included
    Vec3d gradient_center;
    double gradient_variation;  ///< |grad_S f(x) - gradient_center| over the cube, at most, errors included
  };
  Bounds bounds() const;
};

/// psi_P^n(q) = (1-q)^-n - sum_{k<=P} binom(n+k-1,k) q^k: the remainder of the Taylor series of degree P of
/// d^-n over a ball of radius q d, relative to d^-n (tracing.md B5). 0 <= q < 1; summed without cancellation.
double taylor_remainder(int exponent, int degree, double q);

}  // namespace marrow
