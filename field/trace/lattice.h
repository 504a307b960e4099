// A smooth field in a cube as a polynomial through its values on a lattice, and how far off that can be.
#pragma once

#include "field/trace/block_kernels.h"

namespace marrow {

inline constexpr int lattice_side = 5;  ///< nodes per axis, at -1, -1/2, 0, 1/2, 1
inline constexpr int lattice_nodes = lattice_side * lattice_side * lattice_side;

/// `values` holds (f, Gx, Gy, Gz) of node i + 5 j + 25 k; `polynomial` receives far_floats coefficients, in the order
/// of far_field.h. The interpolant of degree 4 in each axis is cut to total degree 4 where that costs least: in its
/// Chebyshev series. Polynomials of total degree 4 are reproduced.
void lattice_polynomial(const float* values, float* polynomial);

/// Finds the constants of LatticeError for sources of f = d^-m, G = m (p - q) d^-(m+2): the error of
/// lattice_polynomial() anywhere in the cube and a thousandth beyond it. The first terms that are cut fall with the
/// distance d as d^-(m+5) and d^-(m+6); nearer sources come as near as d^2 - 3 to the corners.
/// Found numerically, not proved: the largest over 19 distances, seven directions (of which those to the corner, the
/// edge and the face of a cube are the extremes) and 343 points, and a quarter more.
LatticeError lattice_error(int exponent);

}  // namespace marrow
