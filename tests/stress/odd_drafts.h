// Blends as nobody would model them, and at degrees that hardly anybody asks for.
#pragma once

#include <array>

#include "field/blend/blend_field.h"
#include "tests/field/random.h"

namespace marrow::test {

inline constexpr std::size_t odd_kind_count = 6;

/// Within about 1.6 of the origin. Kinds: many skeletons through one point; strands in the same place but for 1e-7;
/// radii that jump at joints, by up to 1000 times; graphs with loops and double edges; points and tubes at dyadic
/// places, so that faces of cells lie in planes of symmetry; degrees 9, 12 and 20 with steep cones.
BlendField odd_blend(std::size_t kind, Random&);

}  // namespace marrow::test
