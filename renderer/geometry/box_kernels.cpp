#include "renderer/geometry/box_kernels.h"

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
  const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                          __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  if (lanes == 16 && has_avx512) return avx512::box_table();
  if (lanes >= 8 && __builtin_cpu_supports("avx2")) return avx2::box_table();
  return sse4::box_table();
}

}  // namespace marrow
