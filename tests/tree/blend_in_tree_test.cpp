// Blends below operators: where one is said to decide, it does.
#include "field/tree/blend_in_tree.h"

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "field/blend/blend_field.h"
#include "field/tree/set_expression.h"
#include "tests/trace/random_scene.h"
#include "tests/tree/random_tree.h"

namespace marrow::test {
namespace {

using Record = std::uint32_t;

bool is_large(const BlendField& blend) { return blend.size() > 4; }

Record large_blend(Random& random, RandomTree& tree) {
  const Setting setting{random.whole(3, 6), random.between(0.2, 1.5)};
  return tree.leaf(BlendLeaf{std::make_shared<BlendField>(random_scene(random, setting, 12))});
}

Record other(Random& random, RandomTree& tree) {
  const Vec3d at = random.vector(1.2);
  const double radius = random.between(0.1, 0.6);
  switch (random.whole(0, 2)) {
    case 0:
      return tree.leaf(Box{.center = at, .size = Vec3d{1, 1, 1} * radius, .rounding = 0, .potential = {}});
    case 1: {
      BlendField blend;
      blend.degree = random.whole(3, 8);
      blend.points.add({at, radius}, {});
      return tree.leaf(BlendLeaf{std::make_shared<const BlendField>(std::move(blend))});
    }
    default:
      return tree.leaf(Sphere{.center = at, .radius = radius, .potential = {}});
  }
}

Record operation(Random& random, RandomTree& tree, Record body, Record other) {
  switch (random.whole(0, 8)) {
    case 0:
      return tree.record(SoftUnion{random.between(0.1, 1), random.between(0.1, 1)}, {body, other});
    case 1:
      return tree.record(SoftUnion{random.between(0.1, 1), random.between(0.1, 1)}, {other, body});
    case 2:
      return tree.record(SoftDifference{random.between(0.1, 1), random.between(1, 2)}, {body, other});
    case 3:
      return tree.record(SoftIntersection{random.between(1, 1.3), random.between(1, 2)}, {body, other});
    case 4:
      return tree.record(Contact{}, {body, other});
    case 5:
      return tree.record(Sum{}, {body, other});
    case 6:
      return tree.record(Ricci{random.between(1, 6)}, {body, other});
    case 7:
      return tree.record(Difference{}, {body, other});
    default:
      return tree.record(SharpUnion{random.between(0, 1)}, {body, other});
  }
}

// One to three operations on a blend, placed somehow.
FieldTree random_tree_of(Random& random) {
  RandomTree draft(random);
  Record body = large_blend(random, draft);
  for (int i = random.whole(1, 3); i > 0; --i) {
    const Affine place = Affine::translate(random.vector(0.3)) *
                         Affine::rotate(normalize(random.vector(1)), random.between(0, 3)) *
                         Affine::scale({random.between(0.5, 1.5), 1, random.between(0.5, 1.5)});
    if (random.between(0, 1) < 0.5) body = draft.record(AffineWarp{place, place.inverse()}, {body});
    const Record with = other(random, draft);
    body = operation(random, draft, body, with);
  }
  return draft.tree();
}

std::vector<std::shared_ptr<const BlendInTree>> lent_blends(Random& random, int trees) {
  std::vector<std::shared_ptr<const BlendInTree>> all;
  for (int i = 0; i < trees; ++i)
    if (auto lent = BlendInTree::of(random_tree_of(random), is_large)) all.push_back(std::move(lent));
  return all;
}

double value_of_blend(const BlendInTree& lent, const Vec3d& p) {
  return corrected_value(*lent.blend(), lent.tree_from_blend().inverse().point(p));
}

Box3 random_box(Random& random, const Vec3d& at) { return Box3{at, at}.padded(std::pow(10, random.between(-4, -0.5))); }

Vec3d random_place(Random& random, const Box3& box) {
  const Vec3d s = box.size();
  return box.lower + Vec3d{s.x * random.between(0, 1), s.y * random.between(0, 1), s.z * random.between(0, 1)};
}

// Where the blend's surface crosses the way from a to b, if it does.
std::optional<Vec3d> surface_between(const BlendInTree& lent, Vec3d a, Vec3d b) {
  const bool is_inside = value_of_blend(lent, a) > 1;
  if ((value_of_blend(lent, b) > 1) == is_inside) return {};
  for (int i = 0; i < 60; ++i) {
    const Vec3d middle = (a + b) * 0.5;
    ((value_of_blend(lent, middle) > 1) == is_inside ? a : b) = middle;
  }
  return a;
}

// Of the blend, beside another body as often as not.
Vec3d place_on_surface(Random& random, const BlendInTree& lent) {
  for (;;)
    if (const auto place = surface_between(lent, random.vector(1.6), random.vector(1.6))) return *place;
}

TEST(BlendInTree, DecidesWhereItIsSaidTo) {
  Random random(421);
  const auto all = lent_blends(random, 150);
  int decided = 0, surfaces = 0, without = 0;
  for (const auto& lent : all)
    for (int i = 0; i < 80; ++i) {
      const Box3 box = random_box(random, i % 2 == 0 ? random.vector(1.6) : place_on_surface(random, *lent));
      const auto decides = lent->decides(box);
      if (!decides) continue;
      for (int k = 0; k < 6; ++k) {
        const Vec3d p = random_place(random, box), q = random_place(random, box);
        const auto surface = surface_between(*lent, p, q);
        const double f = value_of_blend(*lent, p);
        decided += *decides;
        EXPECT_TRUE(!*decides || std::fabs(f - 1) < BlendInTree::tolerance || (value(lent->tree(), p) > 1) == (f > 1));
        if (!surface) continue;
        ++(*decides ? surfaces : without);
        const double off = std::fabs(value(lent->tree(), *surface) - 1);
        EXPECT_TRUE(*decides ? off < 1e-4 : off > 0) << off;
      }
    }
  std::cout << "  " << all.size() << " trees, " << decided << " places, " << surfaces << " on surfaces, " << without
            << " on those that do not count\n";
  EXPECT_GT(all.size(), 60U);
  EXPECT_GT(decided, 20'000);
  EXPECT_GT(surfaces, 5000);
  EXPECT_GT(without, 1000);
}

TEST(BlendInTree, KnowsSidesFromThoseOfTheBlend) {
  Random random(422);
  int told = 0;
  for (const auto& lent : lent_blends(random, 150))
    for (int i = 0; i < 2000; ++i) {
      const Box3 box = random_box(random, random.vector(1.6));
      for (const Side of_blend : {Side::Inside, Side::Outside}) {
        const Side side = lent->side(box, of_blend);
        if (side == Side::Unknown) continue;
        const Vec3d p = random_place(random, box);
        if ((value_of_blend(*lent, p) > 1) != (of_blend == Side::Inside)) continue;
        ++told;
        EXPECT_EQ(value(lent->tree(), p) > 1, side == Side::Inside);
      }
    }
  EXPECT_GT(told, 3000);
}

// A set expression with such a blend as an operand tells the same sides as the tree.
TEST(BlendInTree, IsAnOperand) {
  Random random(423);
  int trees = 0, by_blend = 0;
  for (int i = 0; i < 150; ++i) {
    const FieldTree tree = random_tree_of(random);
    const auto expression = SetExpression::of(tree, tree.root(), is_large);
    if (!expression) continue;
    ++trees;
    const auto& operands = expression->operands();
    for (int k = 0; k < 100; ++k) {
      const Vec3d p = random.vector(1.5);
      const double f = value(tree, p);
      if (std::fabs(f - 1) < 1e-5) continue;
      bool is_whole_asked = false;
      const Side side = expression->side(Box3{p, p}, [&](std::size_t operand) {
        const auto& [blend, map, of_tree, lent] = operands[operand];
        is_whole_asked = is_whole_asked || lent != nullptr;
        const double own = blend != nullptr ? corrected_value(*blend, map.inverse().point(p)) : value(of_tree, p);
        return own > 1 ? Side::Inside : Side::Outside;
      });
      EXPECT_EQ(side, f > 1 ? Side::Inside : Side::Outside);
      by_blend += !is_whole_asked;
    }
  }
  EXPECT_GT(trees, 70);
  EXPECT_GT(by_blend, 5000);
}

TEST(BlendInTree, IsPlacedOnceBelowOperators) {
  Random random(424);
  const auto is_lent = [&](const auto& make) {
    RandomTree draft(random);
    make(draft);
    return BlendInTree::of(draft.tree(), is_large) != nullptr;
  };
  const TreeNode far = Sphere{.center = {9, 0, 0}, .radius = 0.1, .potential = {}},
                 all = Sphere{.center = {}, .radius = 9, .potential = {}};
  EXPECT_TRUE(is_lent([&](RandomTree& t) { t.record(SoftUnion{}, {large_blend(random, t), t.leaf(far)}); }));
  EXPECT_FALSE(is_lent([&](RandomTree& t) { t.record(SoftUnion{}, {t.leaf(far), t.leaf(far)}); }));
  EXPECT_FALSE(is_lent([&](RandomTree& t) {
    const Record twice = large_blend(random, t);
    t.record(SoftUnion{}, {twice, twice});
  }));
  EXPECT_FALSE(is_lent([&](RandomTree& t) {
    t.record(SoftUnion{}, {t.record(Twist{}, {large_blend(random, t)}), t.leaf(far)});
  }));
  // Nothing of its surface is left as it is.
  EXPECT_FALSE(is_lent([&](RandomTree& t) { t.record(SoftUnion{}, {large_blend(random, t), t.leaf(all)}); }));
  EXPECT_FALSE(is_lent([&](RandomTree& t) { large_blend(random, t); }));
}

}  // namespace
}  // namespace marrow::test
