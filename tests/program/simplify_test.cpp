// Merged chains, sums of points and parts of space: the field stays what it was.
#include "field/program/simplify.h"

#include <functional>

#include <gtest/gtest.h>

#include "field/program/field_program.h"
#include "field/tree/any_node.h"
#include "field/tree/tree_node.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

FieldNodeId general(FieldDescription& field, AnyNode node, std::vector<FieldNodeId> of) {
  const FieldNode placed{.what = GeneralNode{.node = boxed(std::move(node)), .of = std::move(of), .material = {}},
                         .where = {}};
  return field.add(placed);
}

FieldNodeId skeleton(FieldDescription& field, const auto& skeleton) {
  Primitive primitive;
  primitive.skeleton = skeleton;
  return field.add({.what = primitive, .where = {}});
}

FieldDescription with_root(FieldDescription field, FieldNodeId root) {
  field.root = root;
  return field;
}

Sphere random_ball(Random& random) {
  Sphere s;
  s.center = random.vector(1.2);
  s.radius = random.between(0.2, 0.8);
  s.potential = WyvillProfile{random.between(0.2, 1.2)};
  return s;
}

// Every kind whose chains are merged, with parameters that are not the defaults.
const AnyNode operations[] = {Sum{},
                              Ricci{3},
                              Intersection{},
                              Difference{},
                              SoftUnion{},
                              SoftDifference{},
                              SoftIntersection{},
                              SharpUnion{0.6},
                              SharpDifference{0.7},
                              SharpIntersection{0.8}};

// f(f(f(a, b), c), d), by hand.
double folded(const AnyNode& operation, const std::vector<double>& f) {
  return std::visit(
      [&]<class Kind>(const Kind& kind) {
        double whole = f[0];
        if constexpr (requires { kind.value(std::span<const double>()); })
          for (std::size_t i = 1; i < f.size(); ++i) {
            const double two[] = {whole, f[i]};
            whole = kind.value(std::span<const double>(two));
          }
        return whole;
      },
      operation);
}

struct Chain {
  FieldDescription field;
  std::vector<Sphere> balls;
};
Chain chain_of(const AnyNode& operation, int length, Random& random) {
  Chain chain;
  const auto ball = [&] {
    chain.balls.push_back(random_ball(random));
    return general(chain.field, chain.balls.back(), {});
  };
  chain.field.root = ball();
  for (int i = 1; i < length; ++i) {
    const FieldNodeId next = ball();
    chain.field.root = general(chain.field, operation, {chain.field.root, next});
  }
  return chain;
}

TEST(Simplify, AChainOfOneOperationIsOneNodeWithTheSameField) {
  Random random(71);
  for (const AnyNode& operation : operations)
    for (int i = 0; i < 40; ++i) {
      const int length = random.whole(3, 7);
      const Chain chain = chain_of(operation, length, random);
      const auto program = compile(chain.field);
      ASSERT_TRUE(program);
      EXPECT_EQ(program->trees()[0].records().size(), static_cast<std::size_t>(length) + 1);
      for (int k = 0; k < 20; ++k) {
        const Vec3d p = random.vector(1.5);
        std::vector<double> f;
        for (const Sphere& s : chain.balls) f.push_back(s.value(p));
        EXPECT_NEAR(value(*program, p), folded(operation, f), 1e-12) << info_of(operation).name << " " << k;
      }
    }
}

TEST(Simplify, WhatTwoPlacesUseStaysANode) {
  FieldDescription field;
  const FieldNodeId a = general(field, Sphere{}, {}), b = general(field, Sphere{}, {});
  const FieldNodeId pair = general(field, Sum{}, {a, b});
  field.root = general(field, Sum{}, {pair, pair});
  const auto program = compile(field);
  ASSERT_TRUE(program);
  EXPECT_EQ(program->trees()[0].records().size(), 4u);
  EXPECT_NEAR(value(*program, {1, 0, 0}), 4, 1e-12);
}

TEST(Simplify, PlacementsOfPlacementsAreOne) {
  FieldDescription field;
  FieldNodeId rest = general(field, Sphere{}, {});
  for (int i = 0; i < 10; ++i) rest = field.add({.what = Transform{Affine::translate({0.1, 0, 0}), rest}, .where = {}});
  field.root = general(field, Twist{}, {rest});
  const auto program = compile(field);
  ASSERT_TRUE(program);
  EXPECT_EQ(program->trees()[0].records().size(), 3u);
  EXPECT_NEAR(value(*program, {2, 0, 0}), 1, 1e-12);
}

// Of a warp that is a placement nothing is left but that, so that blends below it have a tracer of their own.
template <class Warp>
void expect_placement(FieldDescription& field, const Warp& warp, FieldNodeId below, Random& random) {
  const auto alone = compile(with_root(field, below));
  const auto placed = compile(with_root(field, general(field, warp, {below})));
  ASSERT_TRUE(alone && placed);
  EXPECT_EQ(placed->parts().size(), 1u);
  EXPECT_TRUE(placed->trees().empty());
  for (int i = 0; i < 20; ++i) {
    const Vec3d p = random.vector(2);
    const double wanted = value(*alone, warp.child_point(p));
    EXPECT_NEAR(value(*placed, p), wanted, 1e-11 * (1 + wanted));
  }
}

TEST(Simplify, AShearPlacesWhatItSlides) {
  Random random(2026112903);
  for (int round = 0; round < 50; ++round) {
    const Shear shear{random.vector(1), normalize(random.vector(1)), normalize(random.vector(1)),
                      random.between(-3, 3)};
    if (!shear.problem(1).empty()) continue;
    FieldDescription field;
    Blend blend;
    blend.of = {skeleton(field, PointSkeleton{{0, 0, 0}, 0.5}),
                skeleton(field, SegmentSkeleton{{0.4, 0, 0}, {1, 0.5, 0}, 0.3, 0.2})};
    expect_placement(field, shear, field.add({.what = blend, .where = {}}), random);
  }
}

TEST(Simplify, ATaperOfOneWidthPlacesWhatItWidens) {
  Random random(2026112910);
  for (int round = 0; round < 50; ++round) {
    const double width = pow(10, random.between(-1, 1));
    Taper taper{random.vector(1), normalize(random.vector(1)), 1, width, width};
    FieldDescription field;
    const FieldNodeId point = skeleton(field, PointSkeleton{random.vector(1), 0.5});
    expect_placement(field, taper, point, random);
    taper.end *= 1.001;
    EXPECT_TRUE(compile(with_root(field, general(field, taper, {point})))->parts().empty());
  }
}

TEST(Simplify, AShearBeyondMeasureStaysANode) {
  FieldDescription field;
  Shear shear;
  shear.amount = 1e4;
  field.root = general(field, shear, {skeleton(field, PointSkeleton{{0, 0, 0}, 0.5})});
  const auto program = compile(field);
  ASSERT_TRUE(program);
  EXPECT_TRUE(program->parts().empty());
}

// A difference is at most 2, so that of a chain of cuts that are elsewhere one is left, even where the first field is
// above 2.
TEST(Simplify, CutsThatAreElsewhereAreDropped) {
  FieldDescription field;
  Sphere far_away;
  far_away.center = {9, 0, 0};
  field.root = general(field, Sum{}, {general(field, Sphere{}, {}), general(field, Sphere{}, {})});
  for (int i = 0; i < 50; ++i) {
    field.root = general(field, Difference{}, {field.root, general(field, far_away, {})});
    field.root = general(field, SoftUnion{}, {field.root, general(field, far_away, {})});
  }
  const auto program = compile(field);
  ASSERT_TRUE(program);
  const FieldTree less = restricted(program->trees()[0], Box3{{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}});
  EXPECT_EQ(value(less, Vec3d{}), value(*program, Vec3d{}));
  EXPECT_LE(less.records().size(), 6u);
}

TEST(Simplify, ASumOfPointsIsABlend) {
  Random random(72);
  FieldDescription field;
  std::vector<PointSkeleton> points;
  const auto point = [&] {
    points.push_back(random.point());
    Primitive one;
    one.skeleton = points.back();
    return field.add({.what = std::move(one), .where = {}});
  };
  field.root = point();
  for (int i = 0; i < 5; ++i) {
    const FieldNodeId next = point();
    field.root = general(field, Sum{}, {field.root, next});
  }
  const auto program = compile(field);
  ASSERT_TRUE(program);
  EXPECT_TRUE(is_single_blend(*program));
  for (int k = 0; k < 50; ++k) {
    const Vec3d p = random.vector(3);
    double sum = 0;
    for (const PointSkeleton& s : points) sum += integer_power(s.radius / length(p - s.at), 3);
    EXPECT_NEAR(value(*program, p) / sum, 1, 1e-12);
  }
}

TEST(Simplify, AUnionOfVeryManyPointsIsOneTree) {
  Random random(73);
  FieldDescription field;
  std::vector<FieldNodeId> all;
  std::vector<PointSkeleton> points;
  for (int i = 0; i < 1200; ++i) {
    points.push_back(random.point());
    Primitive one;
    one.skeleton = points.back();
    all.push_back(field.add({.what = std::move(one), .where = {}}));
  }
  field.root = field.add({.what = Union{std::move(all)}, .where = {}});
  const auto program = compile(field);
  ASSERT_TRUE(program);
  EXPECT_TRUE(program->parts().empty());
  EXPECT_EQ(members(program->trees()[0]).size(), 1200u);
  for (int k = 0; k < 20; ++k) {
    const Vec3d p = random.vector(2);
    double most = 0;
    for (const PointSkeleton& s : points) most = std::max(most, integer_power(s.radius / length(p - s.at), 3));
    EXPECT_NEAR(value(*program, p) / most, 1, 1e-12);
  }
}

// In a box, for trees of two operations one in the other.
TEST(Restriction, KeepsTheFieldOfEveryOperation) {
  Random random(74);
  std::vector<AnyNode> all(std::begin(operations), std::end(operations));
  for (const Bulge& bulge : {Bulge{PlainBulge{}}, Bulge{HeightBulge{}}, Bulge{RippleBulge{}}})
    for (const bool first_only : {false, true}) all.push_back(Contact{.bulge = bulge, .first_only = first_only});
  const auto any = [&] { return all[static_cast<std::size_t>(random.whole(0, static_cast<int>(all.size()) - 1))]; };
  std::size_t smaller = 0;
  for (int i = 0; i < 1000; ++i) {
    FieldDescription field;
    std::vector<FieldNodeId> groups;
    for (int g = 0; g < 3; ++g) {
      std::vector<FieldNodeId> of;
      for (int k = random.whole(2, 6); k > 0; --k) of.push_back(general(field, random_ball(random), {}));
      groups.push_back(general(field, any(), std::move(of)));
    }
    field.root = general(field, any(), std::move(groups));
    const auto program = compile(field);
    ASSERT_TRUE(program);
    const FieldTree& tree = program->trees()[0];
    const Vec3d center = random.vector(1.3);
    const double half = pow(10, random.between(-2, -0.3));
    const FieldTree part = restricted(tree, Box3{center, center}.padded(half));
    smaller += part.records().size() < tree.records().size();
    for (int k = 0; k < 20; ++k) {
      const Vec3d p = center + random.vector(half);
      ASSERT_NEAR(value(part, p), value(tree, p), 1e-12) << "tree " << i;
    }
  }
  EXPECT_GT(smaller, 700u);
}

}  // namespace
}  // namespace marrow
