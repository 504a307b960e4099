// The field of a block in eight cubes, the patches: a polynomial each, accurate enough to tell where the surface can
// be.
#pragma once

#include <array>

#include "field/trace/block_kernels.h"
#include "field/trace/lattice.h"

namespace marrow {

class IsoCurve;

/// Errors of interpolation by lattice_polynomial() for the sources of a blend: curves, and points.
struct LatticeErrors {
  LatticeError curves, points;
  explicit LatticeErrors(int degree) : curves(degree), points(degree - 1) {}
};

/// Builds the patches of one block from its field `level`. In each, surface can only be in the box and below the plane:
/// sub-cells of a quarter of the patch's side are ruled out where the largest values at their corners, raised by what
/// the polynomial can bend between them and by all errors, lie outside the iso curve.
/// Polynomials are written to `polynomials`, room for patch_count of them.
void build_patches(const FieldLevel& level, int degree, const IsoCurve&, const LatticeErrors&, const BlockKernels&,
                   float* polynomials, Patches&);

}  // namespace marrow
