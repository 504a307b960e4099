// The box kernels compiled for avx512 (see renderer/geometry/CMakeLists.txt for its compiler options).
#include "renderer/geometry/box_kernels.h"

namespace marrow::avx512 {
namespace {
// In this order: each builds on those before.
// clang-format off
#include "field/trace/kernels/lanes/native.h"
#include "field/trace/kernels/lanes/doubles.h"
#include "renderer/geometry/kernels/rays_among_boxes.h"
// clang-format on
}  // namespace

const BoxKernels& box_table() {
  static constexpr BoxKernels kernels{start, note};
  return kernels;
}

}  // namespace marrow::avx512
