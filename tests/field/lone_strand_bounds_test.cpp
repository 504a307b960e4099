// Bounds of a blend of one strand by distance, which the operator leaves as it is.
#include <cmath>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "field/blend/bounds/blend_bounds.h"
#include "field/math/elementary.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

// One polyline by distance, whatever the kernel, angle, cavity and projection.
BlendField lone_strand(Random& random, int i) {
  BlendField blend;
  blend.degree = random.whole(3, 8);
  blend.kernel = i % 3 == 0 ? KernelFamily::Inverse : i % 3 == 1 ? KernelFamily::Cauchy : KernelFamily::Compact;
  if (i % 3 != 0) blend.kernel_shape = i % 3 == 1 ? random.between(0.5, 2) : random.between(1.2, 3);
  blend.alpha = random.between(0, std::numbers::pi / 2);
  blend.cavity = random.between(0, 1) < 0.7;
  if (random.between(0, 1) < 0.3) blend.projection = Projection::Exact;
  Vec3d at = random.vector(1);
  for (int k = random.whole(1, 5); k > 0; --k) {
    const Vec3d next = at + random.vector(1);
    blend.distance_segments.skeletons.push_back({at, next, random.between(0.2, 0.8), random.between(0.2, 0.8)});
    blend.distance_segments.strands.push_back(0);
    at = next;
  }
  return blend;
}

// The operator leaves it alone, so that bounds narrow, and slopes are known, where one segment takes over from another.
TEST(LoneStrandBounds, HoldAtPlacesAndAcrossKinks) {
  Random random(60);
  int bounded = 0, alone = 0;
  for (int i = 0; i < 6000; ++i) {
    const BlendField blend = lone_strand(random, i);
    const Vec3d middle = random.vector(1.5);
    const Vec3d half = random.vector(1) * pow(10.0, random.between(-4, -0.5));
    const Stretch stretch{half, half * random.between(1, 3), 1e-15};
    Box3 box;
    box.include(middle - half);
    box.include(middle + half);
    const BlendBounds bounds = blend_bounds(blend, box, Wanted::Slopes, &stretch);
    const BlendBounds around = blend_bounds(blend, box);
    bounded += bounds.along.width() < 1e300;
    alone += std::fabs(corrected_value(blend, middle) - evaluate(blend, middle).sum) < 1e-12;
    double before = 0;
    for (int k = 0; k <= 8; ++k) {
      const double t = -1 + 0.25 * k;
      const BlendSample s = evaluate(blend, middle + half * t);
      if (s.sum > 1e50) break;
      for (const Interval& value : {bounds.value, around.value})
        ASSERT_TRUE(value.lo <= s.corrected && s.corrected <= value.hi)
            << "case " << i << ": " << s.corrected << " not in [" << value.lo << ", " << value.hi << "]";
      // secants lie between slopes, at kinks too
      const double way = 0.25 * dot(half, stretch.direction) / length_squared(stretch.direction);
      const double rise = s.corrected - before, slack = 1e-12 * (1 + s.corrected);
      if (k > 0) {
        ASSERT_TRUE(bounds.along.lo * way - slack <= rise && rise <= bounds.along.hi * way + slack)
            << "case " << i << ": " << rise / way << " not in [" << bounds.along.lo << ", " << bounds.along.hi << "]";
      }
      before = s.corrected;
    }
  }
  std::cout << "  " << bounded << " with slopes, " << alone << " left alone\n";
  EXPECT_GT(bounded, 4000);
  EXPECT_GT(alone, 4000);
}

}  // namespace
}  // namespace marrow
