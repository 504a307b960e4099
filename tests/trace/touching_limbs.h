// Limbs side by side between which C is nearly 1.
#pragma once

#include <cmath>

#include "field/blend/blend_field.h"
#include "field/math/ray.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {

/// Two limbs along x, a little apart or into each other, at the angle near that of contact at which C is 1 at a place
/// in the middle between them. There it hardly changes along them.
inline BlendField touching_limbs(Random& random, int degree) {
  BlendField blend = random_scene(random, {degree, 0}, 0);
  const double r = 0.4, side = random.between(0, 1) < 0.5 ? -1 : 1;
  const double gap = side * std::pow(10.0, random.between(-6, -2.5));
  for (const double z : {-r * (1 + gap / 2), r * (1 + gap / 2)})
    blend.segments.add({{-1.3, 0, z}, {1.3, 0, z}, r, r}, {});
  const Vec3d touch{random.between(0.03, 0.5), 0, 0};
  double least = 0.5, most = 1.55;
  for (int i = 0; i < 50; ++i) {
    blend.alpha = 0.5 * (least + most);
    (corrected_value(blend, touch) < 1 ? least : most) = blend.alpha;
  }
  return blend;
}

/// Along the limbs to where they meet, in the middle between them, one in ten along their line of symmetry.
inline Ray between_limbs(Random& random) {
  const double side = random.between(0, 1) < 0.5 ? -1 : 1;
  const double y = random.whole(0, 9) == 0 ? 0 : random.between(-0.03, 0.03);
  return {{7 * side, y, 0}, UnitVec3::unchecked({-side, 0, 0})};
}

}  // namespace marrow::test
