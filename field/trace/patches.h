// The field of a block in patches: cubes with a polynomial each, accurate enough to tell where surface can be.
#pragma once

#include <vector>

#include "field/trace/block_kernels.h"
#include "field/trace/lattice.h"

namespace marrow {

class IsoCurve;

/// Errors of interpolation by lattice_polynomial() for the sources of a blend: curves, and points.
struct LatticeErrors {
  LatticeError curves, points;
  explicit LatticeErrors(int degree) : curves(degree), points(degree - 1) {}
};

/// The patches of one block. In each, surface can only be in a box and below a plane: cells of a quarter of the patch's
/// side are ruled out where the values at their corners, raised by what the polynomial can bend between them and by all
/// errors, lie outside the iso curve, or so far above 1 that all is inside.
struct Patches {
  std::vector<PatchNode> nodes;  ///< the first divides the block
  std::vector<float> polynomials;
  float lower[3], upper[3];  ///< of a box around all surface, when there is any
};

/// `level` is the field, in block coordinates; its errors are against the exact field.
Patches make_patches(const FieldLevel& level, int degree, const IsoCurve&, const LatticeErrors&, const BlockKernels&);

}  // namespace marrow
