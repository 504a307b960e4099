// A smooth field in a cube as a polynomial through its values on a lattice, and how far off that can be.
#pragma once

#include <vector>

namespace marrow {

inline constexpr int lattice_side = 5;  ///< nodes per axis, at -1, -1/2, 0, 1/2, 1
inline constexpr int lattice_nodes = lattice_side * lattice_side * lattice_side;

/// `values` holds (f, Gx, Gy, Gz) of node i + 5 j + 25 k; `polynomial` receives far_floats coefficients, in the order
/// of far_field.h. The interpolant of degree 4 in each axis is cut to total degree 4 where that costs least: in its
/// Chebyshev series. Polynomials of total degree 4 are reproduced.
void lattice_polynomial(const float* values, float* polynomial);

/// Bounds the error of lattice_polynomial() for one source of f = d^-m, G = m (p - q) d^-(m+2), anywhere in the cube
/// and a thousandth beyond it, by the distance of the source from the centre of the cube. Found numerically, not
/// proved: the largest error over seven directions (of which those to the corner, the edge and the face of a cube are
/// the extremes) and 343 points, times a quarter more. Beyond eight half sides the error falls at least as fast as the
/// first term that is cut, distance^-(m+5).
class LatticeError {
 public:
  explicit LatticeError(int exponent);
  struct Bound {
    float field, gradient;
  };
  /// Infinite where the source is too near.
  Bound at(float distance_squared) const;

 private:
  static constexpr int steps_per_octave = 8, octaves = 5;  // of the squared distance, from `nearest` on
  static constexpr float nearest = 2;
  int exponent_;
  std::vector<Bound> table_;
};

}  // namespace marrow
