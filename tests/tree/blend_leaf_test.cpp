// A blend as a node of a tree keeps the laws of fields: whatever its skeletons, kernel, projection and rule of the
// angle.
#include <iostream>
#include <string>

#include <gtest/gtest.h>

#include "field/tree/blend_values.h"
#include "tests/field/varied_blend.h"
#include "tests/tree/laws_in_doubles.h"

namespace marrow::test {
namespace {

struct Leaf {
  BlendField blend;
  template <Number X>
  X value(const Vec3<X>& p) const {
    return tree::blend_value(blend, tree::Place<X>::outermost(p));
  }
  // What the doubles themselves may be off.
  double rounding() const { return blend.kernel == KernelFamily::Compact && !blend.arcs.empty() ? 1e-7 : 1e-11; }
};

// Now and then with a triangle.
Leaf random_leaf(Random& random, int round) {
  Leaf leaf{varied_blend(random, round)};
  const bool may_hold_triangles = leaf.blend.direction_bounds.empty() && !leaf.blend.alpha_per_skeleton;
  if (may_hold_triangles && round % 40 < 3) leaf.blend.triangles.add(random.triangle(), {});
  return leaf;
}

// Points near skeletons, between them and far away.
Vec3d place(Random& random, int i) { return random.vector(i % 5 == 0 ? 0.3 : i % 5 == 4 ? 8 : 2.2); }

TEST(BlendLeaf, EnclosuresHoldValuesAndSlopes) {
  Random random(20260102);
  Checks checks;
  for (int round = 0; checks.enclosures < wanted_checks() && !HasFailure(); ++round) {
    SCOPED_TRACE("blend " + std::to_string(round));
    const Leaf leaf = random_leaf(random, round);
    for (int i = 0; i < 20 && !HasFailure(); ++i) {
      expect_enclosures_in_doubles(leaf, random_box(place(random, i), random), random, checks);
      expect_ray_enclosures_in_doubles(leaf, place(random, i), random, checks);
    }
  }
  std::cout << "  " << checks.enclosures << " enclosures\n";
}

TEST(BlendLeaf, DerivativesAreThoseOfDifferences) {
  Random random(20260103);
  Checks checks;
  for (int round = 0; checks.slopes < wanted_checks() && !HasFailure(); ++round) {
    SCOPED_TRACE("blend " + std::to_string(round));
    const Leaf leaf = random_leaf(random, round);
    for (int i = 0; i < 20 && !HasFailure(); ++i)
      expect_derivatives_in_doubles(leaf, place(random, i), i % 4 == 0, checks);
  }
  std::cout << "  " << checks.slopes << " slopes, " << checks.rough_slopes << " at kinks; " << checks.curvatures
            << " curvatures, " << checks.rough_curvatures << " at kinks\n";
  EXPECT_LT(checks.rough_slopes, checks.slopes / 20);
  EXPECT_LT(checks.rough_curvatures, checks.curvatures / 10);
}

TEST(BlendLeaf, IsBelowALevelOutsideItsExtent) {
  Random random(20260111);
  for (int round = 0; round < 400 && !HasFailure(); ++round) {
    SCOPED_TRACE("blend " + std::to_string(round));
    const Leaf leaf = random_leaf(random, round);
    const bool ends = leaf.blend.kernel == KernelFamily::Compact;
    const double level = ends && round % 2 == 0 ? 0 : random.between(0.05, 1.5);
    const Box3 box = blend_extent(leaf.blend, level);
    for (std::size_t face = 0; face < 6; ++face) {
      Vec3d p = point_in(box, random);
      const std::size_t axis = face / 2;
      const double out = pow(10.0, random.between(-9, 0.5));
      p[axis] = face % 2 == 0 ? box.lower[axis] - out : box.upper[axis] + out;
      EXPECT_LE(leaf.value(p), level) << "face " << face;
    }
  }
}

}  // namespace
}  // namespace marrow::test
