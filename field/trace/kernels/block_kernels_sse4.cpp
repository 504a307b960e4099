// The block kernels compiled for sse4 (see field/trace/CMakeLists.txt for its compiler options).
#include <type_traits>

#include "field/trace/kernels/block_kernels.h"

namespace marrow::sse4 {
namespace {
#include "field/trace/kernels/all.h"
}  // namespace

const BlockKernels& table() { return all_kernels; }

}  // namespace marrow::sse4
