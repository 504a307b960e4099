// Crisp operations for sharp ones: the same insides, and the same fields wherever an operator sees them.
#include "field/program/crisp_surface.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "field/program/field_program.h"
#include "field/tree/any_node.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

FieldNodeId general(FieldDescription& field, AnyNode node, std::vector<FieldNodeId> of) {
  return field.add(
      {.what = GeneralNode{.node = boxed(std::move(node)), .of = std::move(of), .material = {}}, .where = {}});
}

FieldNodeId ball(FieldDescription& field, Random& random) {
  Sphere s;
  s.center = random.vector(1.2);
  s.radius = random.between(0.3, 0.9);
  return general(field, s, {});
}

FieldNodeId pair(FieldDescription& field, Random& random) {
  Blend blend;
  for (int i = 0; i < 2; ++i) {
    Primitive primitive;
    primitive.skeleton = random.segment();
    blend.of.push_back(field.add({.what = primitive, .where = {}}));
  }
  return field.add({.what = blend, .where = {}});
}

AnyNode operation(Random& random) {
  const AnyNode all[] = {SharpUnion{0.6},  SharpDifference{0.7}, SharpIntersection{0.8}, SharpUnion{},
                         SoftUnion{},      Difference{},         Intersection{},         Ricci{3},
                         SoftDifference{}, SharpDifference{}};
  return all[static_cast<std::size_t>(random.whole(0, 9))];
}

// Some nodes have several parents.
FieldDescription random_field(Random& random) {
  FieldDescription field;
  std::vector<FieldNodeId> made{ball(field, random), ball(field, random), pair(field, random)};
  const auto any = [&] { return made[static_cast<std::size_t>(random.whole(0, static_cast<int>(made.size()) - 1))]; };
  for (int i = 0; i < 5; ++i) {
    const FieldNodeId below = made.back(), other = random.between(0, 1) < 0.5 ? any() : ball(field, random);
    made.push_back(general(field, operation(random), {below, other}));
    if (random.between(0, 1) < 0.2) made.push_back(general(field, Twist{}, {made.back()}));
  }
  field.root = made.back();
  return field;
}

std::size_t sharp_operations(const FieldDescription& field) {
  std::size_t count = 0;
  for (const FieldNode& node : field.nodes)
    if (const auto* general = std::get_if<GeneralNode>(&node.what)) {
      const AnyNode& kind = general->node->node;
      count += std::holds_alternative<SharpUnion>(kind) || std::holds_alternative<SharpIntersection>(kind) ||
               std::holds_alternative<SharpDifference>(kind);
    }
  return count;
}

TEST(CrispSurface, InsidesStayWhatTheyWere) {
  Random random(2026112905);
  std::size_t inside = 0, outside = 0, replaced = 0, kept = 0;
  for (int i = 0; i < 1500; ++i) {
    const FieldDescription field = random_field(random);
    const auto crisp = crisp_surface(field);
    if (!crisp) continue;
    replaced += sharp_operations(field) - sharp_operations(*crisp);
    kept += sharp_operations(*crisp);
    const auto exact = compile(field), simple = compile_surface(field);
    ASSERT_TRUE(exact && simple);
    for (int k = 0; k < 50; ++k) {
      const Vec3d p = random.vector(1);
      const double f = value(*exact, p);
      if (std::fabs(f - 1) < 1e-9) continue;
      ++(f > 1 ? inside : outside);
      EXPECT_EQ(value(*simple, p) > 1, f > 1)
          << "field " << i << " at " << p.x << ' ' << p.y << ' ' << p.z << ": " << f;
    }
  }
  EXPECT_GT(inside, 4000u);
  EXPECT_GT(outside, 5000u);
  EXPECT_GT(replaced, 300u);
  EXPECT_GT(kept, 100u);
}

TEST(CrispSurface, WhatIsBlendedFurtherStaysSharp) {
  Random random(2026112906);
  FieldDescription field;
  const FieldNodeId sharp = general(field, SharpUnion{}, {ball(field, random), ball(field, random)});
  const FieldNodeId sum = general(field, Sum{}, {sharp, ball(field, random)});
  const FieldNodeId seen_both_ways = general(field, Intersection{}, {sum, sharp});
  field.root = seen_both_ways;
  EXPECT_FALSE(crisp_surface(field));
  field.root = general(field, SharpDifference{}, {seen_both_ways, ball(field, random)});
  const auto crisp = crisp_surface(field);
  ASSERT_TRUE(crisp);
  EXPECT_EQ(sharp_operations(*crisp), 1u);
}

// The angle of a blend follows the field as it is.
TEST(CrispSurface, AFieldOfAnglesStaysSharp) {
  Random random(2026112907);
  FieldDescription field;
  const FieldNodeId sharp = general(field, SharpUnion{}, {ball(field, random), ball(field, random)});
  const FieldNodeId blend = pair(field, random);
  std::get<Blend>(field.nodes[blend.index()].what).alpha = AlphaFromField{sharp, {}};
  field.root = field.add({.what = Union{{blend}}, .where = {}});
  EXPECT_FALSE(crisp_surface(field));
}

// So that each member has what traces it best.
TEST(CrispSurface, ASharpUnionIsTakenApart) {
  Random random(2026112908);
  FieldDescription field;
  const FieldNodeId first = pair(field, random), second = pair(field, random);
  field.root = general(field, SharpUnion{}, {first, second});
  const auto exact = compile(field), simple = compile_surface(field);
  ASSERT_TRUE(exact && simple);
  EXPECT_EQ(exact->trees().size(), 1u);
  EXPECT_TRUE(simple->trees().empty());
  EXPECT_EQ(simple->parts().size(), 2u);
}

}  // namespace
}  // namespace marrow
