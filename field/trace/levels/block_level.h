// One of the two levels of a block.
#pragma once

#include "field/base/huge_pages.h"
#include "field/trace/kernels/block_kernels.h"

namespace marrow {

/// With certified bounds of its difference from the exact field, over its cell.
struct alignas(64) BlockLevel : InHugePages {
  FieldLevel level;
  double f_error = 0, gradient_error = 0;
  double angle_error = 0;  ///< of level.angle; where there are strands, of the share of angles: an estimate
  bool is_weak = false;    ///< floats do not tell the field of all strands but the strongest
};

}  // namespace marrow
