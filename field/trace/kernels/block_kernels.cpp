#include "field/trace/kernels/block_kernels.h"

#include "field/math/instruction_sets.h"

namespace marrow {
namespace sse4 {
const BlockKernels& table();
}
namespace avx2 {
const BlockKernels& table();
}
namespace avx512 {
const BlockKernels& table();
}

const BlockKernels* block_kernels(std::string_view name) {
  if (has_avx512() && (name.empty() || name == "avx512")) return &avx512::table();
  if (has_avx2() && (name.empty() || name == "avx2")) return &avx2::table();
  if (name.empty() || name == "sse4") return &sse4::table();
  return nullptr;
}

}  // namespace marrow
