// A patch of the share of the range of angles, fitted to what strands tell of its places.
#pragma once

#include "field/trace/kernels/block_kernels.h"
#include "field/trace/kernels/share_part.h"

namespace marrow {

/// Least squares of values and slopes at strand_place of the cube of a patch, whose `center` and `inverse_half` say
/// where that is in the block; sets its coefficients.
/// Returns the largest residual, of the share, or of its slopes over half sides of the cube, which count less.
double fit_share(const StrandShares&, SharePatch&);

}  // namespace marrow
