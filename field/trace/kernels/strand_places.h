// The places where cubes ask for strands, as vectors: kernels know none.
#pragma once

#include <cstddef>

#include "field/math/vec3.h"
#include "field/trace/kernels/block_kernels.h"

namespace marrow {

/// strand_place[k] in the cube [-1, 1]^3, 0 <= k < strand_places.
inline Vec3d place_in_cube(std::size_t k) {
  return {static_cast<double>(strand_place[k][0]), static_cast<double>(strand_place[k][1]),
          static_cast<double>(strand_place[k][2])};
}

}  // namespace marrow
