// What lies far from a cube, as Taylor polynomials about its centre: the field f (degree P = 4, 6 or 8), and the
// potential F with grad F = grad_S f (degree P + 1, so that grad_S f has degree P too).
//
// Coordinates are the cube's own: x = (p - centre) / half, so the cube is [-1, 1]^3. All lengths that
// enter (radii, source positions) are in these units; f is dimensionless, and F here is F / half, so
// that its gradient in x is grad_S f itself.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "field/math/moment_series.h"
#include "field/math/monomials.h"
#include "field/math/vec3.h"

namespace marrow {

inline constexpr int low_far_degree = 4, high_far_degree = 6, highest_far_degree = 8;       ///< P
inline constexpr std::size_t monomial_count = monomials_to_degree(highest_far_degree + 1);  // 220

/// x^a y^b z^c, sorted by degree.
inline constexpr auto monomials = make_monomials<highest_far_degree + 1>();

using Polynomial = std::array<double, monomial_count>;

/// Turns moments of sources r about the origin into the Taylor coefficients of sum w |x - r|^-m.
class MomentTable {
 public:
  /// For one exponent m and one P.
  MomentTable(int exponent, int far_degree) : far_degree_(far_degree), series_(exponent, far_degree + 1) {}
  /// With y = r / |r|^2 and the field f_i = w |r|^-m of a source at the origin, `f`: sums of f_i y^(tensor k) for
  /// k <= P, in the order of `monomials`; `potential`: of f_i tau_i y^(tensor k) for k <= P + 1.
  void add(const float* f, const float* potential, struct FarField&) const;

 private:
  int far_degree_;
  MomentSeries series_;
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

}  // namespace marrow
