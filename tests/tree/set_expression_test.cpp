// Trees as set operations: sides, and which operand decides.
#include "field/tree/set_expression.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/tree/random_tree.h"

namespace marrow::test {
namespace {

// A ball as a blend, which stands alone, or as a primitive.
std::uint32_t ball(Random& random, RandomTree& tree) {
  const Vec3d at = random.vector(1);
  const double radius = random.between(0.5, 1.5);
  if (random.between(0, 1) < 0.4) return tree.leaf(Sphere{.center = at, .radius = radius, .potential = {}});
  BlendField blend;
  blend.points.add({at, radius}, {});
  return tree.leaf(BlendLeaf{std::make_shared<const BlendField>(std::move(blend))});
}

std::uint32_t operations(Random& random, RandomTree& tree, int levels) {
  if (levels == 0) return ball(random, tree);
  std::vector<std::uint32_t> of;
  for (int i = random.whole(1, 3); i > 0; --i) of.push_back(operations(random, tree, random.whole(0, levels - 1)));
  const Affine place = Affine::translate(random.vector(0.5)) *
                       Affine::rotate(normalize(Vec3d{1, random.between(0, 1), 0}), random.between(0, 3));
  const double smooth = random.between(0, 1);
  switch (random.whole(0, 6)) {
    case 0:
      return tree.record(CrispUnion{}, of);
    case 1:
      return tree.record(Intersection{}, of);
    case 2:
      return tree.record(AffineWarp{place, place.inverse()}, {of[0]});
    case 3:
      return tree.record(SharpUnion{smooth}, of);
    case 4:
      return tree.record(SharpIntersection{smooth}, of);
    case 5:
      return tree.record(SharpDifference{smooth}, of);
    default:
      return tree.record(Difference{}, of);
  }
}

bool stands_alone(const BlendField&) { return true; }

constexpr Box3 anywhere{};

double value_of(const SetExpression::Operand& operand, const Vec3d& p) {
  if (operand.blend == nullptr) return value(operand.tree, p);
  return corrected_value(*operand.blend, operand.world_from_blend.inverse().point(p));
}

struct Scene {
  FieldTree tree;
  SetExpression expression;
};

// Those of 300 random trees that have a blend that stands alone.
std::vector<Scene> scenes(Random& random) {
  std::vector<Scene> made;
  for (int i = 0; i < 300; ++i) {
    RandomTree draft(random);
    operations(random, draft, 3);
    FieldTree tree = draft.tree();
    if (auto expression = SetExpression::of(tree, tree.root(), stands_alone))
      made.push_back({std::move(tree), std::move(*expression)});
  }
  return made;
}

TEST(SetExpression, TellsTheSideOfTheTree) {
  Random random(411);
  int inside = 0, trees = 0, of_several = 0, decided = 0;
  for (const auto& [tree, expression] : scenes(random)) {
    ++trees;
    of_several += expression.operands().size() > 2;
    for (int i = 0; i < 100; ++i) {
      const Vec3d p = random.vector(1.5);
      std::vector<Side> sides;
      for (const auto& operand : expression.operands())
        sides.push_back(value_of(operand, p) >= 1 ? Side::Inside : Side::Outside);
      const auto side_of = [&](std::size_t k) { return sides[k]; };
      const Side side = expression.side(Box3{p, p}, side_of);
      EXPECT_EQ(side, value(tree, p) >= 1 ? Side::Inside : Side::Outside);
      inside += side == Side::Inside;
      for (std::size_t k = 0; k < sides.size(); ++k) {
        const auto flipped = [&](std::size_t j) { return j == k ? opposite(sides[j]) : sides[j]; };
        const bool changes = expression.side(Box3{p, p}, flipped) != side;
        EXPECT_EQ(expression.counts(k, Box3{p, p}, side_of), changes);
        EXPECT_TRUE(!changes || (side == sides[k]) != expression.is_taken_away(k));
        decided += changes;
      }
    }
  }
  EXPECT_GT(trees, 200);
  EXPECT_GT(of_several, 80);
  EXPECT_GT(inside, 3000);
  EXPECT_GT(decided, 10'000);
}

// Whatever those of which it is not known say.
TEST(SetExpression, IsNotWrongWhereSidesAreUnknown) {
  Random random(412);
  int told = 0;
  for (const auto& [tree, expression] : scenes(random)) {
    std::vector<Side> known, all;
    for (std::size_t k = 0; k < expression.operands().size(); ++k) {
      known.push_back(static_cast<Side>(random.whole(0, 2)));
      all.push_back(known.back());
      if (known.back() == Side::Unknown) all.back() = random.between(0, 1) < 0.5 ? Side::Inside : Side::Outside;
    }
    const auto side_known = [&](std::size_t k) { return known[k]; };
    const auto side_of_all = [&](std::size_t k) { return all[k]; };
    if (const Side side = expression.side(anywhere, side_known); side != Side::Unknown) {
      ++told;
      EXPECT_EQ(side, expression.side(anywhere, side_of_all));
    }
    for (std::size_t k = 0; k < known.size(); ++k)
      if (const auto counts = expression.counts(k, anywhere, side_known)) {
        EXPECT_EQ(*counts, expression.counts(k, anywhere, side_of_all));
      }
  }
  EXPECT_GT(told, 50);
}

TEST(SetExpression, LeavesToTheTreeWhatItIsNotFor) {
  Random random(413);
  const auto is_expression = [&](const auto& make) {
    RandomTree draft(random);
    make(draft);
    const FieldTree tree = draft.tree();
    return SetExpression::of(tree, tree.root(), stands_alone).has_value();
  };
  BlendField blend;
  blend.points.add({{}, 1}, {});
  const TreeNode leaf = BlendLeaf{std::make_shared<const BlendField>(blend)},
                 sphere = Sphere{.center = {}, .radius = 1, .potential = {}};
  EXPECT_TRUE(is_expression([&](RandomTree& t) { t.record(Difference{}, {t.leaf(leaf), t.leaf(sphere)}); }));
  EXPECT_FALSE(is_expression([&](RandomTree& t) { t.record(Difference{}, {t.leaf(sphere), t.leaf(sphere)}); }));
  EXPECT_FALSE(is_expression([&](RandomTree& t) { t.record(Twist{}, {t.leaf(leaf)}); }));
  EXPECT_FALSE(is_expression([&](RandomTree& t) {
    std::vector<std::uint32_t> many{t.leaf(leaf)};
    for (std::size_t i = 0; i <= SetExpression::most_beside; ++i) many.push_back(t.leaf(sphere));
    t.record(Difference{}, many);
  }));
  // However deep, without a stack for each level.
  EXPECT_FALSE(is_expression([&](RandomTree& t) {
    std::uint32_t root = t.leaf(leaf);
    for (int i = 0; i < 200'000; ++i) root = t.record(Difference{}, {root, root});
  }));
}

}  // namespace
}  // namespace marrow::test
