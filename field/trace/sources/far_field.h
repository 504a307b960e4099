// What lies far from a cube, as Taylor polynomials about its centre: the field f (degree P = 4, 6 or 8), and the
// potential F with grad F = grad_S f (degree P + 1, so that grad_S f has degree P too).
//
// Coordinates are the cube's own: x = (p - centre) / half, so the cube is [-1, 1]^3. All lengths that
// enter (radii, source positions) are in these units; f is dimensionless, and F here is F / half, so
// that its gradient in x is grad_S f itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "field/math/vec3.h"

namespace marrow {

/// Monomials of degree <= k in three variables: binom(k + 3, 3).
constexpr std::size_t monomials_to_degree(int k) { return static_cast<std::size_t>((k + 1) * (k + 2) * (k + 3) / 6); }

inline constexpr int low_far_degree = 4, high_far_degree = 6, highest_far_degree = 8;       ///< P
inline constexpr std::size_t monomial_count = monomials_to_degree(highest_far_degree + 1);  // 220

/// Exponents of the monomials x^a y^b z^c, sorted by degree.
struct Monomial {
  int a, b, c;
  constexpr int degree() const { return a + b + c; }
};
inline constexpr std::array<Monomial, monomial_count> monomials = [] {
  std::array<Monomial, monomial_count> m{};
  std::size_t i = 0;
  for (int d = 0; d <= highest_far_degree + 1; ++d)
    for (int a = d; a >= 0; --a)
      for (int b = d - a; b >= 0; --b) m[i++] = {a, b, d - a - b};
  return m;
}();
constexpr std::size_t monomial_index(int a, int b, int c) {
  const int d = a + b + c, rest = d - a;
  return monomials_to_degree(d - 1) + static_cast<std::size_t>(rest * (rest + 1) / 2 + rest - b);
}

using Polynomial = std::array<double, monomial_count>;

/// Turns moments of sources r about the origin into the Taylor coefficients of sum w |x - r|^-m.
/// The expansion is the Gegenbauer series, |x - r|^-m = sum_k C_k^(m/2)(cos) |x|^k |r|^-(m+k). Its terms are
/// (x.r)^k |x|^(2j) |r|^-(m+2k+2j) times a constant, so the moments needed for the degree P + 1 are
///   sum w r^(tensor k) |r|^-(m+2k+2j)   for k + 2j <= P + 1
/// (56 + 20 + 4 numbers for P = 4). With y = r / |r|^2 and the field f_i = w |r|^-m of a source at the origin they are
/// sums of f_i y^(tensor k) |y|^(2j); those with j = 0 give the others, as |y|^2 is a sum of three squares.
class MomentTable {
 public:
  /// For one exponent m and one P.
  MomentTable(int exponent, int far_degree);
  /// `f`: sums of f_i y^(tensor k) for k <= P, in the order of `monomials`; `potential`: of f_i tau_i y^(tensor k) for
  /// k <= P + 1.
  void add(const float* f, const float* potential, struct FarField&) const;

 private:
  struct Term {
    std::uint16_t moment, monomial;
    double factor;
  };
  struct Moments;
  Moments moments(const float* sums, int degree) const;
  int far_degree_;
  std::vector<Term> terms_;      // by the degree of their monomials
  std::size_t field_terms_ = 0;  // those of degree P at most
};

struct FarField {
  int degree = 0;  ///< P: coefficients of higher degrees than P and P + 1 are 0
  Polynomial f{}, potential{};
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
