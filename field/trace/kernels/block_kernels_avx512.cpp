// The block kernels compiled for avx512 (see field/trace/CMakeLists.txt for its compiler options).
#include <type_traits>

#include "field/trace/kernels/block_kernels.h"

namespace marrow::avx512 {
namespace {
#include "field/trace/kernels/all.h"
}  // namespace

const BlockKernels& table() { return all_kernels; }

}  // namespace marrow::avx512
