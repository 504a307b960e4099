// Programs in boxes are what they are in all of space, to within what sums over nodes are off.
#include "field/program/programs_in_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "field/tree/tree_node.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

PlacedBlend placed(BlendField blend, const Affine& world_from_local) {
  return {
      .blend = std::move(blend), .world_from_local = world_from_local, .local_from_world = world_from_local.inverse()};
}

FieldTree ball_of(const Vec3d& center, double radius) {
  auto nodes = std::make_shared<std::vector<TreeNode>>();
  nodes->push_back(Sphere{.center = center, .radius = radius, .potential = {}});
  return FieldTree(std::move(nodes), {{.node = 0, .first_child = 0, .child_count = 0, .material = {}, .support = {}}},
                   {});
}

// Two blends of hundreds of skeletons, one of them placed, and a ball.
FieldProgram random_program(Random& random, int n) {
  const double contact = contact_alpha(n);
  const Affine place = Affine::translate(random.vector(1)) * Affine::scale({1, 0.7, 1.2});
  return FieldProgram({placed(random_scene(random, {.degree = n, .alpha = contact}, 300), {}),
                       placed(random_scene(random, {.degree = n, .alpha = 0.3}, 100), place)},
                      {ball_of(random.vector(1), 0.5)});
}

TEST(ProgramsInBox, AreThoseOfAllOfSpace) {
  Random random(301);
  double farthest = 0, steepest = 0;
  for (const int n : {3, 4, 6}) {
    const FieldProgram first = random_program(random, n), second = random_program(random, n);
    const std::array<const FieldProgram*, 2> both{&first, &second};
    const ProgramsInBox all(both);
    for (int i = 0; i < 40; ++i) {
      const Vec3d center = random.vector(i % 4 == 0 ? 6 : 1.5);
      const double half = random.between(0.02, 0.4);
      // Flat, as of a slice; and one in the other.
      const Box3 outer = Box3{center, center}.padded(2 * half),
                 box{center - Vec3d{half, half, 0}, center + Vec3d{half, half, 0}};
      const ProgramsInBox here = i % 2 == 0 ? all.within(box) : all.within(outer).within(box);
      for (int k = 0; k < 10; ++k) {
        const Vec3d p = random_in(random, box);
        const FieldSample a = evaluate(first, p), b = evaluate(second, p), &largest = a.value >= b.value ? a : b;
        const FieldSample found = here.at(p), whole = all.at(p);
        EXPECT_NEAR(whole.value, largest.value, 1e-12 * (1 + std::fabs(largest.value)));
        const double off = std::fabs(found.value - largest.value) / (1 + largest.value);
        farthest = std::max(farthest, off);
        EXPECT_LT(off, 2e-7) << "n=" << n << " at " << p.x << ' ' << p.y << ' ' << p.z;
        if (std::fabs(a.value - b.value) < 1e-6) continue;
        const double turn = length(found.gradient - largest.gradient) / (1 + length(largest.gradient));
        steepest = std::max(steepest, turn);
        EXPECT_LT(turn, 1e-6) << "n=" << n;
      }
    }
  }
  std::cout << "  values are off by up to " << farthest << ", gradients by " << steepest << '\n';
}

TEST(ProgramsInBox, OfNothingAreZero) {
  const FieldProgram nothing;
  const std::array<const FieldProgram*, 1> one{&nothing};
  const ProgramsInBox here = ProgramsInBox(one).within(Box3{{0, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(here.at({0.5, 0.5, 0.5}).value, 0);
  EXPECT_EQ(count_of_all(nothing), 0U);
}

TEST(ProgramsInBox, CountPrimitivesAndNodes) {
  Random random(302);
  EXPECT_EQ(count_of_all(random_program(random, 4)), 401U);
}

}  // namespace
}  // namespace marrow::test
