// Places that warps have moved: what is known of them beside boxes holds, is closer than these, and so do fields of
// blends there.
#include "field/tree/place.h"

#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "field/tree/machine.h"
#include "tests/field/varied_blend.h"
#include "tests/tree/laws_in_doubles.h"
#include "tests/tree/random_node.h"

namespace marrow::test {
namespace {

using tree::Place;

UnitVec3 way(Random& random) { return normalize(random.vector(1)); }

TreeNode random_warp(Random& random) {
  const Vec3d center = random.vector(0.5);
  switch (random.whole(0, 3)) {
    case 0:
      return Twist{center, way(random), random.between(-3, 3)};
    case 1:
      return Taper{.center = center,
                   .axis = way(random),
                   .length = random.between(0.5, 2),
                   .start = random.between(0.4, 2),
                   .end = random.between(0.4, 2)};
    case 2:
      return Shear{center, way(random), way(random), random.between(-1, 1)};
    default:
      return marrow::Bend{center, way(random), way(random), random.between(0.5, 3), random.between(0, 5)};
  }
}

// Through one warp after the other; nothing where space is cut there.
template <Number X>
std::optional<Place<X>> moved(const std::vector<TreeNode>& warps, const Vec3<X>& p) {
  Place<X> at = Place<X>::outermost(p);
  std::vector<Vec3<X>> further;
  for (const TreeNode& warp : warps) {
    at = place_of_children(warp, at, further);
    if (!further.empty()) return {};
  }
  return at;
}

std::vector<TreeNode> random_warps(Random& random) {
  std::vector<TreeNode> warps;
  for (int i = random.whole(1, 3); i > 0; --i) warps.push_back(random_warp(random));
  return warps;
}

Vec3d place_of(const std::vector<TreeNode>& warps, const Vec3d& p) { return moved<double>(warps, p)->p; }

// How much closer than boxes.
struct Closeness {
  int parts = 0, asked = 0;
  double of_box = 0;

  void add(double radius, const Box3& box) {
    ++parts;
    of_box += radius / (0.5 * length(box.size()));
  }
};

void expect_holds(const Box3& box, const Vec3d& q) {
  ASSERT_TRUE(box.padded(1e-12 * (1 + length(q))).contains(q)) << "outside its box";
}

// check(warps, closeness) of chains of warps.
template <class Check>
Closeness for_random_warps(Random& random, const Check& check) {
  Closeness closeness;
  for (int round = 0; round < 4000 && !testing::Test::HasFailure(); ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    check(random_warps(random), closeness);
  }
  std::cout << "  " << closeness.parts << " of " << closeness.asked << " closer, " << closeness.of_box / closeness.parts
            << " of the radius of the box\n";
  return closeness;
}

TEST(Place, PartsHoldWhatWarpsMakeOfBoxes) {
  Random random(20261128);
  const Closeness closeness = for_random_warps(random, [&](const std::vector<TreeNode>& warps, Closeness& told) {
    const Vec3d center = random.vector(1.5), half = abs(random.vector(pow(10, random.between(-4, -0.5))));
    const auto there = moved(warps, jet_variables(places_in(Box3{center - half, center + half})));
    if (!there) return;
    ++told.asked;
    const auto part = there->part();
    if (part) told.add(part->shape.radius(), there->box());
    for (int k = 0; k < 8; ++k) {
      const Vec3d share = random.vector(1);
      const Vec3d q = place_of(warps, center + Vec3d{share.x * half.x, share.y * half.y, share.z * half.z});
      expect_holds(there->box(), q);
      if (!part) continue;
      expect_holds(part->box, q);
      Vec3d off = q - part->box.center();
      for (std::size_t i = 0; i < 3; ++i) off -= part->shape.halves[i] * share[i];
      EXPECT_LE(length(off), part->shape.slack * (1 + 1e-12));
    }
  });
  EXPECT_GT(closeness.parts, 0.5 * closeness.asked);
  EXPECT_LT(closeness.of_box / closeness.parts, 0.95);
}

TEST(Place, PartsHoldWhatWarpsMakeOfPiecesOfRays) {
  Random random(20261129);
  const Closeness closeness = for_random_warps(random, [&](const std::vector<TreeNode>& warps, Closeness& told) {
    const Vec3d origin = random.vector(1.5), direction = random.vector(1);
    const double end = pow(10, random.between(-5, 0));
    const RayBounds t = RayBounds::variable({0, end}, 0);
    const auto there = moved(warps, constant<RayBounds>(origin) + constant<RayBounds>(direction) * t);
    if (!there) return;
    ++told.asked;
    const auto part = there->part();
    if (part) told.add(length(part->shape.half) + part->shape.slack, there->box());
    const auto at = [&](double share) { return place_of(warps, origin + direction * (0.5 * (1 + share) * end)); };
    for (int k = 0; k < 8; ++k) {
      const double share = random.between(-1, 1), step = 1e-3;
      const Vec3d q = at(share);
      expect_holds(there->box(), q);
      if (!part) continue;
      const Stretch& way = part->shape;
      expect_holds(part->box, q);
      EXPECT_LE(length(q - part->box.center() - way.half * share), way.slack * (1 + 1e-12));
      const Vec3d slope = (at(share + step) - at(share - step)) / (step * end);
      EXPECT_LE(length(slope - way.direction), way.turn * (1 + 1e-2) + 1e-9 * (1 + 1 / end));
    }
  });
  EXPECT_GT(closeness.parts, 0.8 * closeness.asked);
}

// A blend under warps.
struct Warped {
  std::vector<TreeNode> warps;
  BlendField blend;
  template <Number X>
  X value(const Vec3<X>& p) const {
    const auto at = moved(warps, p);
    if constexpr (is_enclosure<X>)
      if (!at) return any_slope<X>(Interval(0, Box3::inf));
    return tree::blend_value(blend, *at);
  }
  double rounding() const { return 1e-9; }
};

TEST(Place, FieldsOfBlendsAreEnclosedUnderWarps) {
  Random random(20261130);
  Checks checks;
  for (int round = 0; checks.enclosures < wanted_checks() && !HasFailure(); ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Warped field{random_warps(random), varied_blend(random, round)};
    for (int i = 0; i < 10 && !HasFailure(); ++i) {
      expect_enclosures_in_doubles(field, random_box(random.vector(1.5), random), random, checks);
      expect_ray_enclosures_in_doubles(field, random.vector(1.5), random, checks);
    }
  }
  std::cout << "  " << checks.enclosures << " enclosures\n";
}

}  // namespace
}  // namespace marrow::test
