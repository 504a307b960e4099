// Blends as nobody would model them, and at degrees that hardly anybody asks for.
#pragma once

#include <array>

#include "field/blend/blend_field.h"
#include "tests/field/random.h"

namespace marrow::test {

inline constexpr std::size_t odd_kind_count = 12;

/// Within about 1.6 of the origin. Kinds: many skeletons through one point; strands in the same place but for 1e-7;
/// radii that jump at joints, by up to 1000 times; graphs with loops and double edges; points and tubes at dyadic
/// places, so that faces of cells lie in planes of symmetry; degrees 9 to 20 with steep cones; two balls or limbs on
/// both sides of contact, down to 1e-9, without cavity or with the exact projection as well; cones of radii from 1e-4
/// to 0.5 and as short; hairs thousands of radii long; segments of a thousandth of their radius, whose bodies are
/// smaller; hollow bodies without cavity at small angles, where the field reaches 60; dust.
BlendField odd_blend(std::size_t kind, Random&);

}  // namespace marrow::test
