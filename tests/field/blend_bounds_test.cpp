// Bounds over boxes against the field at points in them.
#include "field/blend/bounds/blend_bounds.h"

#include <cmath>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "field/math/elementary.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

BlendField random_blend(Random& random) {
  BlendField blend;
  blend.degree = random.whole(3, 6);
  const int family = random.whole(0, 5);
  if (family == 4) blend.kernel = KernelFamily::Cauchy;
  if (family == 5) blend.kernel = KernelFamily::Compact, blend.kernel_shape = 2;
  const bool inverse = blend.kernel == KernelFamily::Inverse;
  blend.alpha = !inverse || random.between(0, 1) < 0.2 ? std::numbers::pi / 2 : random.between(-0.9, 1.5);
  blend.cavity = random.between(0, 1) < 0.8;
  if (blend.alpha >= 0 && random.between(0, 1) < 0.3) blend.projection = Projection::Exact;
  for (int i = random.whole(1, 3); i > 0; --i) {
    const int kind = inverse ? random.whole(0, 4) : random.whole(0, 1);
    if (kind == 0) blend.points.add(random.point(), {});
    if (kind == 1) blend.segments.add(random.segment(), {});
    if (kind == 2) blend.distance_segments.add(random.segment(), {});
    if (kind == 3) blend.arcs.add(random.arc(), {});
    if (kind == 4) blend.triangles.add(random.triangle(), {});
  }
  return blend;
}

TEST(BlendBounds, HoldAtPointsOfTheBox) {
  Random random(51);
  int bounded = 0, sloped = 0;
  for (int i = 0; i < 1500; ++i) {
    const BlendField blend = random_blend(random);
    const Vec3d center = random.vector(2.5);
    const double half = pow(10, random.between(-4, -0.2));
    const Box3 box = Box3{center, center}.padded(half);
    const BlendBounds bounds = blend_bounds(blend, box);
    bounded += bounds.value.hi < 1e300;
    for (int k = 0; k < 6; ++k) {
      const Vec3d p = center + random.vector(half);
      const BlendSample s = evaluate(blend, p);
      ASSERT_TRUE(bounds.value.contains(s.corrected))
          << "case " << i << " of half size " << half << ": " << s.corrected << " not in [" << bounds.value.lo << ", "
          << bounds.value.hi << "], alpha " << blend.alpha << " degree " << blend.degree;
      if (!blend.cavity) continue;  // its gradient is not bounded
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (s.sum > 1e50) continue;
        const Interval& g = bounds.gradient[axis];
        const double slack = 1e-9 * (1 + length(s.corrected_gradient));
        ASSERT_TRUE(g.lo - slack <= s.corrected_gradient[axis] && s.corrected_gradient[axis] <= g.hi + slack)
            << "case " << i << " axis " << axis << ": " << s.corrected_gradient[axis] << " not in [" << g.lo << ", "
            << g.hi << "], alpha " << blend.alpha << " degree " << blend.degree << " exact "
            << (blend.projection == Projection::Exact);
        sloped += g.hi - g.lo < 1e300;
      }
    }
  }
  EXPECT_GT(bounded, 700);
  EXPECT_GT(sloped, 5000);
}

// Fails where the value or a slope is not within its bounds; returns how many slopes have any.
int check_place(const BlendBounds& bounds, const BlendSample& at, double slack_of_slopes) {
  EXPECT_TRUE(bounds.value.contains(at.corrected))
      << at.corrected << " not in [" << bounds.value.lo << ", " << bounds.value.hi << "]";
  const double slack = slack_of_slopes * (1 + length(at.corrected_gradient));
  int sloped = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Interval& g = bounds.gradient[axis];
    const double slope = at.corrected_gradient[axis];
    EXPECT_TRUE(g.lo - slack <= slope && slope <= g.hi + slack)
        << "axis " << axis << ": " << slope << " not in [" << g.lo << ", " << g.hi << "]";
    sloped += g.width() < 1e300;
  }
  return sloped;
}

// Kernels of finite heights, with the distance model and any angle.
BlendField blend_of_finite_height(Random& random) {
  BlendField blend;
  blend.degree = random.whole(3, 7);
  blend.kernel = random.between(0, 1) < 0.7 ? KernelFamily::Compact : KernelFamily::Cauchy;
  blend.kernel_shape = random.between(1.2, 3);
  blend.alpha = random.between(0, 1) < 0.4 ? std::numbers::pi / 2 : random.between(0, 1.5);
  if (random.between(0, 1) < 0.5) blend.projection = Projection::Exact;
  for (int i = random.whole(1, 3); i > 0; --i) {
    const int kind = random.whole(0, 11);
    if (kind < 3) blend.points.add(random.point(), {});
    if (kind >= 3 && kind < 7) blend.segments.add(random.segment(), {});
    if (kind == 7 || kind == 8) blend.distance_segments.add(random.segment(), {});
    if (kind == 9) blend.arcs.add(random.arc(), {});
    if (kind < 10) continue;
    TriangleSkeleton triangle = random.triangle();
    if (kind == 11) triangle.radii = {triangle.radii[0], triangle.radii[0], triangle.radii[0]};
    blend.triangles.add(triangle, {});
  }
  return blend;
}

TEST(BlendBounds, HoldForKernelsOfFiniteHeight) {
  Random random(54);
  int sloped = 0;
  for (int i = 0; i < 1500; ++i) {
    const BlendField blend = blend_of_finite_height(random);
    const Vec3d center = random.vector(2);
    const double half = pow(10, random.between(-5, -0.2));
    const BlendBounds bounds = blend_bounds(blend, Box3{center, center}.padded(half));
    for (int k = 0; k < 8; ++k) sloped += check_place(bounds, evaluate(blend, center + random.vector(half)), 1e-8);
    ASSERT_FALSE(HasFailure()) << "case " << i << " of half size " << half << ", degree " << blend.degree;
  }
  EXPECT_GT(sloped, 5000);
}

// Ends that differ by up to three times the length, seen from everywhere: behind the apex, from where the cone ends.
BlendField blend_of_steep_cones(Random& random) {
  BlendField blend;
  blend.degree = random.whole(3, 7);
  const double kind = random.between(0, 1);
  if (kind < 0.5) blend.kernel = kind < 0.25 ? KernelFamily::Compact : KernelFamily::Cauchy;
  if (kind < 0.5) blend.kernel_shape = random.between(1.2, 3);
  blend.alpha = random.between(0, 1) < 0.4 ? std::numbers::pi / 2 : random.between(0, 1.5);
  for (int i = random.whole(1, 2); i > 0; --i) {
    SegmentSkeleton s = random.segment();
    s.to =
        s.from + normalize(random.vector(1)) * (std::fabs(s.radius_to - s.radius_from) / random.between(0.3, 3) + 0.01);
    blend.distance_segments.add(s, {});
  }
  return blend;
}

// Boxes around places that may be near a blend, of all sizes: what is bounded holds, and small boxes have narrow
// bounds.
template <class Blend, class Center>
void check_boxes(unsigned seed, const Blend& make_blend, const Center& center_of, int least_sloped,
                 double least_narrow) {
  Random random(seed);
  int sloped = 0, narrow = 0, small = 0;
  for (int i = 0; i < 4000; ++i) {
    const BlendField blend = make_blend(random);
    const Vec3d center = center_of(random, blend);
    const double half = pow(10, random.between(-5, -0.2));
    const BlendBounds bounds = blend_bounds(blend, Box3{center, center}.padded(half));
    small += half < 1e-3;
    narrow += half < 1e-3 && bounds.gradient.x.width() < 0.3 + 0.3 * std::fabs(bounds.gradient.x.middle());
    for (int k = 0; k < 8; ++k) {
      const BlendSample at = evaluate(blend, center + random.vector(half));
      if (at.sum > 1e50) continue;
      sloped += check_place(bounds, at, 1e-8);
    }
    ASSERT_FALSE(testing::Test::HasFailure())
        << "case " << i << " of half size " << half << ", degree " << blend.degree;
  }
  std::cout << "  " << sloped << " slopes bounded, " << narrow << " of " << small << " small boxes narrow\n";
  EXPECT_GT(sloped, least_sloped);
  EXPECT_GT(narrow, least_narrow * small);
}

TEST(BlendBounds, HoldForSteepConesByDistance) {
  check_boxes(
      59, blend_of_steep_cones,
      [](Random& random, const BlendField& blend) {
        const SegmentSkeleton& s = blend.distance_segments.skeletons.front();
        return lerp(s.from, s.to, random.between(-2, 3)) + random.vector(1.5);
      },
      60000, 0.8);
}

// Of triangles whose radii differ by up to three times their size, likewise.
BlendField blend_of_steep_triangles(Random& random) {
  BlendField blend = blend_of_steep_cones(random);
  for (const SegmentSkeleton& s : blend.distance_segments.skeletons) {
    const Vec3d third = lerp(s.from, s.to, random.between(-0.5, 1.5)) + random.vector(length(s.to - s.from));
    const double radius = random.between(0, 1) < 0.5 ? s.radius_from : s.radius_to * random.between(0.5, 2);
    blend.distance_triangles.add({{s.from, s.to, third}, {s.radius_from, s.radius_to, radius}}, {});
  }
  blend.distance_segments = {};
  return blend;
}

// Somewhere around; or a place whose nearest one is inside the triangle, while the radius over its foot is small.
Vec3d place_near_steep_triangle(Random& random, const TriangleSkeleton& t) {
  const auto& [a, b, c] = t.vertices;
  if (t.radii[0] == t.radii[1] || random.between(0, 1) < 0.5)
    return lerp(lerp(a, b, random.between(-2, 3)), c, random.between(-1, 2)) + random.vector(1.5);
  const Vec3d first = b - a, second = c - a, across = cross(first, second);
  const Vec3d rise =
      (cross(second, across) * (t.radii[1] - t.radii[0]) + cross(across, first) * (t.radii[2] - t.radii[0])) /
      length_squared(across);
  const double u = random.between(0, 1), v = random.between(0, 1 - u), steep = length_squared(rise);
  const double radius = t.radii[0] + (t.radii[1] - t.radii[0]) * u + (t.radii[2] - t.radii[0]) * v;
  const double foot_radius = radius * random.between(0, 0.5), lean = (radius - foot_radius) / steep;
  return a + first * u + second * v - rise * lean + normalize(across) * std::sqrt(lean * foot_radius);
}

TEST(BlendBounds, HoldForSteepTrianglesByDistance) {
  check_boxes(
      60, blend_of_steep_triangles,
      [](Random& random, const BlendField& blend) {
        return place_near_steep_triangle(random, blend.distance_triangles.skeletons.front());
      },
      60000, 0.7);
}

// Of one radius or not, rings among them; most boxes are around places near the arc, some near its axis and its back,
// where the nearest place jumps.
BlendField blend_of_arcs(Random& random) {
  BlendField blend = blend_of_steep_cones(random);
  blend.distance_segments = {};
  for (int i = random.whole(1, 2); i > 0; --i) {
    ArcSkeleton arc = random.arc();
    if (random.between(0, 1) < 0.4) arc.radius_to = arc.radius_from;
    if (random.between(0, 1) < 0.2) arc.end = arc.begin + 2 * std::numbers::pi;
    blend.distance_arcs.add(arc, {});
  }
  return blend;
}

TEST(BlendBounds, HoldForArcsByDistance) {
  check_boxes(
      61, blend_of_arcs,
      [](Random& random, const BlendField& blend) {
        const ArcSkeleton& s = blend.distance_arcs.skeletons.front();
        const double angle = random.between(s.begin - 0.5, s.end + 0.5);
        const double away = random.between(0, 1) < 0.8 ? random.between(0.3, 2.5) : random.between(-1.5, 0.3);
        return s.center + (s.axis1 * std::cos(angle) + s.axis2 * std::sin(angle)) * (s.major * away) +
               random.vector(s.major * random.between(0, 1));
      },
      50000, 0.9);
}

// Their radius is that at the foot of the place, which stays at the ends beyond them: slopes jump there.
BlendField blend_of_cani_hornus(Random& random) {
  BlendField blend;
  blend.degree = 3;
  blend.alpha = random.between(0, 1) < 0.5 ? std::numbers::pi / 2 : random.between(-0.9, 1.5);
  for (int i = random.whole(1, 3); i > 0; --i) blend.cani_hornus_segments.add(random.segment(), {});
  return blend;
}

TEST(BlendBounds, HoldForSegmentsOfCaniAndHornus) {
  Random random(58);
  int sloped = 0, narrow = 0, small = 0;
  for (int i = 0; i < 3000; ++i) {
    const BlendField blend = blend_of_cani_hornus(random);
    const double half = pow(10, random.between(-7, -0.2));
    const SegmentSkeleton& s = blend.cani_hornus_segments.skeletons[0];
    const Vec3d end = (i % 4 == 0 ? s.from : s.to), away = cross(s.to - s.from, random.vector(1));
    const Vec3d center = i % 2 == 0 ? end + away * random.between(0.1, 1) + random.vector(half) : random.vector(2);
    const BlendBounds bounds = blend_bounds(blend, Box3{center, center}.padded(half));
    for (int k = 0; k < 8; ++k) {
      const BlendSample b = evaluate(blend, center + random.vector(half));
      if (b.sum > 1e50) continue;
      sloped += check_place(bounds, b, 1e-9);
    }
    ASSERT_FALSE(HasFailure()) << "case " << i << " of half size " << half;
    // between its ends nothing jumps
    const BlendSample at = evaluate(blend, center);
    if (i % 2 == 0 || half > 1e-6 || !(at.corrected > 0.1 && at.corrected < 2)) continue;
    ++small;
    narrow += bounds.gradient.x.width() < 1e-2 * (1 + length(at.corrected_gradient));
  }
  std::cout << "  " << sloped << " slopes bounded, " << narrow << " of " << small << " small boxes narrow\n";
  EXPECT_GT(sloped, 40'000);
  EXPECT_GT(small, 20);
  EXPECT_GT(narrow, 0.8 * small);
}

// Half of them along a segment of the blend, where the compact kernel knows what changes.
Stretch stretch_near(Random& random, const BlendField& blend, Vec3d& middle) {
  const double size = pow(10, random.between(-5, 0));
  Vec3d way = normalize(random.vector(1)) * size;
  if (!blend.segments.skeletons.empty() && random.between(0, 1) < 0.5) {
    const SegmentSkeleton& s = blend.segments.skeletons[0];
    const Vec3d along = normalize(s.to - s.from).vec(), beside = normalize(cross(along, random.vector(1))).vec();
    middle = lerp(s.from, s.to, random.between(-0.3, 1.3)) + beside * (s.radius_from * random.between(0.5, 3));
    way = along * size + beside * (size * pow(10, random.between(-8, -1)));
  }
  return {way, way * random.between(0.5, 3), 1e-14};
}

TEST(BlendBounds, HoldAlongStretches) {
  Random random(56);
  int bounded = 0, sloped = 0;
  for (int i = 0; i < 4000; ++i) {
    BlendField blend = i % 2 == 0 ? random_blend(random) : blend_of_finite_height(random);
    if (!blend.cavity) continue;
    if (i % 4 == 1)
      for (SegmentSkeleton& s : blend.segments.skeletons) s.radius_to = s.radius_from;
    Vec3d middle = random.vector(2);
    const Stretch stretch = stretch_near(random, blend, middle);
    Box3 box;
    box.include(middle - stretch.half);
    box.include(middle + stretch.half);
    const BlendBounds bounds = blend_bounds(blend, box, Wanted::Slopes, &stretch);
    bounded += bounds.value.hi < 1e300;
    sloped += bounds.along.width() < 1e300;
    for (int k = 0; k < 8; ++k) {
      const BlendSample s = evaluate(blend, box.center() + stretch.half * random.between(-1, 1));
      if (s.sum > 1e50) continue;
      ASSERT_TRUE(bounds.value.contains(s.corrected))
          << "case " << i << ": " << s.corrected << " not in [" << bounds.value.lo << ", " << bounds.value.hi
          << "], degree " << blend.degree;
      const double slope = dot(s.corrected_gradient, stretch.direction);
      const double slack = 1e-8 * length(stretch.direction) * (1 + length(s.corrected_gradient));
      ASSERT_TRUE(bounds.along.lo - slack <= slope && slope <= bounds.along.hi + slack)
          << "case " << i << ": " << slope << " not in [" << bounds.along.lo << ", " << bounds.along.hi << "], degree "
          << blend.degree;
    }
  }
  EXPECT_GT(bounded, 1500);
  EXPECT_GT(sloped, 1200);
}

// To nothing in the end, but for the edge of a support that an arc follows.
TEST(BlendBounds, NarrowForKernelsOfFiniteHeight) {
  Random random(55);
  int near = 0;
  for (int i = 0; i < 600; ++i) {
    BlendField blend = blend_of_finite_height(random);
    blend.arcs = {};
    const Vec3d p = random.vector(1.5);
    const BlendSample s = evaluate(blend, p);
    if (!(s.corrected > 0.3 && s.corrected < 1.5)) continue;
    ++near;
    const double width = blend_bounds(blend, Box3{p, p}.padded(1e-9)).value.width();
    EXPECT_LT(width, 1e-4) << "case " << i << " degree " << blend.degree;
  }
  EXPECT_GT(near, 50);
}

TEST(BlendBounds, NarrowWithTheBox) {
  Random random(52);
  for (int i = 0; i < 40; ++i) {
    BlendField blend;
    blend.segments.add(random.segment(), {});
    blend.alpha = 0.7;
    const Vec3d p = normalize(random.vector(1)) * 3.0;
    const double wide = blend_bounds(blend, Box3{p, p}.padded(1e-2)).value.width();
    const double narrow = blend_bounds(blend, Box3{p, p}.padded(1e-3)).value.width();
    EXPECT_LT(narrow, 0.12 * wide);
  }
}

TEST(BlendExtent, TheCompactKernelEndsAtItsSupport) {
  BlendField blend;
  blend.kernel = KernelFamily::Compact;
  blend.kernel_shape = 2;
  blend.points.add({{1, 0, 0}, 0.5}, {});
  const Box3 box = blend_extent(blend, 0);
  EXPECT_LT(length(box.lower - Vec3d{0, -1, -1}), 1e-11);
  EXPECT_LT(length(box.upper - Vec3d{2, 1, 1}), 1e-11);
  EXPECT_EQ(corrected_value(blend, {2.001, 0, 0}), 0);
  blend.kernel = KernelFamily::Inverse;
  EXPECT_EQ(blend_extent(blend, 0).upper.x, Box3::inf);
}

TEST(BlendExtent, IsBelowTheLevelOutside) {
  Random random(53);
  for (int i = 0; i < 300; ++i) {
    const BlendField blend = random_blend(random);
    const double level = pow(10, random.between(-2, 0.3));
    const Box3 box = blend_extent(blend, level);
    for (int k = 0; k < 5; ++k) {
      Vec3d p = box.center() + random.vector(1.5 * max_component(box.size()));
      if (box.contains(p)) p[static_cast<std::size_t>(random.whole(0, 2))] = box.upper.x + box.size().x;
      if (box.contains(p)) continue;
      EXPECT_LT(corrected_value(blend, p), level);
    }
  }
}

}  // namespace
}  // namespace marrow
