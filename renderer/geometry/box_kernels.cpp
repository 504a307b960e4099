#include "renderer/geometry/box_kernels.h"

#include "field/math/instruction_sets.h"

namespace marrow {
namespace sse4 {
const BoxKernels& box_table();
}
namespace avx2 {
const BoxKernels& box_table();
}
namespace avx512 {
const BoxKernels& box_table();
}

const BoxKernels& box_kernels(int lanes) {
  if (lanes == 16 && has_avx512()) return avx512::box_table();
  if (lanes >= 8 && has_avx2()) return avx2::box_table();
  return sse4::box_table();
}

}  // namespace marrow
