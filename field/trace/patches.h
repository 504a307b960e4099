// The field of a block in patches: cubes with a polynomial each, accurate enough to tell where surface can be.
#pragma once

#include <memory>

#include "field/trace/block_kernels.h"
#include "field/trace/iso_curve.h"
#include "field/trace/lattice.h"
#include "field/trace/lazy.h"

namespace marrow {

/// What patches are made from: a field in block coordinates whose errors are against the exact one.
struct PatchSource {
  const FieldLevel& level;
  int degree;
  const IsoCurve& iso;
  const LatticeError (&errors)[2];  ///< of curves, and of points
  const BlockKernels& kernels;
  bool polynomials;  ///< else all patches are left to the sources: where few rays come, polynomials do not pay
};

struct Cube {
  float center[3], half;

  Cube octant(int i) const {
    Cube c{.center = {}, .half = 0.5F * half};
    for (int k = 0; k < 3; ++k) c.center[k] = center[k] + (i >> k & 1 ? c.half : -c.half);
    return c;
  }
};

/// The octants of a cube that may hold surface; their patches are made when the first ray comes. Those bounds over
/// cubes prove to be outside or inside are dropped.
class OctantPatches : public Octants {
 public:
  /// The source must outlive them. `depth`: divisions of the block, this one included.
  OctantPatches(const PatchSource&, const Cube&, int depth);
  ~OctantPatches();

 private:
  struct Owned;
  std::unique_ptr<const Owned> make(int octant) const;

  const PatchSource& source_;
  Cube cube_;
  int depth_;
  float f_error_[8], g_error_[8];  // of polynomials through lattices
  Lazy<Owned> patches_[8];
};

}  // namespace marrow
