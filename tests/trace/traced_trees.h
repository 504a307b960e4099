// Random trees of all kinds of nodes, and what their tracer finds asked cell by cell, without a hierarchy.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "field/math/affine.h"
#include "field/program/field_program.h"
#include "field/trace/general/crossing.h"
#include "field/trace/general/tree_tracer.h"
#include "field/tree/any_node.h"
#include "tests/field/random.h"

namespace marrow::test {

inline FieldNodeId add(FieldDescription& field, AnyNode node, std::vector<FieldNodeId> of = {}) {
  return field.add(
      {.what = GeneralNode{.node = boxed(std::move(node)), .of = std::move(of), .material = {}}, .where = {}});
}

/// The only tree of a field that ends in this node. A Ricci blend of one keeps its root a general node.
inline FieldTree tree_above(FieldDescription& field, FieldNodeId last) {
  field.root = add(field, Ricci{1}, {last});
  const auto program = compile(field);
  EXPECT_TRUE(program) << program.why()[0].message;
  EXPECT_EQ(program->trees().size(), 1u);
  return program->trees()[0];
}

inline FieldNodeId ball(FieldDescription& field, Random& random) {
  Sphere s;
  s.center = random.vector(1.2);
  s.radius = random.between(0.2, 0.9);
  s.potential = WyvillProfile{random.between(0.2, 1.5)};
  return add(field, s);
}

inline Primitive tube(Random& random) {
  Primitive one;
  one.skeleton = random.segment();
  return one;
}

inline FieldNodeId tubes(FieldDescription& field, Random& random) {
  Blend blend;
  for (int i = random.whole(1, 3); i > 0; --i) blend.of.push_back(field.add({.what = tube(random), .where = {}}));
  double angle = 0;
  if (random.between(0, 1) < 0.4) blend.alpha = angle = random.between(-1, 1.5);
  if (random.between(0, 1) < 0.3 && angle >= 0) blend.projection = Projection::Exact;
  return field.add({.what = std::move(blend), .where = {}});
}

inline FieldNodeId leaf(FieldDescription& field, Random& random) {
  return random.between(0, 1) < 0.7 ? ball(field, random) : tubes(field, random);
}

inline FieldNodeId combined(FieldDescription& field, Random& random, std::vector<FieldNodeId> of) {
  switch (random.whole(0, 4)) {
    case 0:
      return add(field, Intersection{}, std::move(of));
    case 1:
      return add(field, Difference{}, std::move(of));
    case 2:
      return add(field, Ricci{random.between(1, 9)}, std::move(of));
    case 3: {
      const FieldNodeId inner = field.add({.what = Union{std::move(of)}, .where = {}});
      Twist twist;
      twist.angle_per_length = random.between(-1.5, 1.5);
      return add(field, twist, {inner});
    }
    default:
      return field.add({.what = Union{std::move(of)}, .where = {}});
  }
}

inline FieldTree random_tree(Random& random) {
  FieldDescription field;
  std::vector<FieldNodeId> layer;
  for (int i = random.whole(2, 5); i > 0; --i) layer.push_back(leaf(field, random));
  while (layer.size() > 1) {
    const FieldNodeId a = layer.back();
    layer.pop_back();
    const FieldNodeId b = layer.back();
    layer.pop_back();
    layer.insert(layer.begin(), combined(field, random, {b, a}));
  }
  const Affine map = Affine::rotate(normalize(random.vector(1)), random.between(0, 3)) *
                     Affine::scale({random.between(0.6, 1.4), random.between(0.6, 1.4), 1});
  return tree_above(field, field.add({.what = Transform{map, layer[0]}, .where = {}}));
}

/// Of a field that is one tree.
inline TreeTracer tracer_of(const FieldDescription& field) {
  const auto program = compile(field);
  EXPECT_TRUE(program) << program.why()[0].message;
  auto tracer = TreeTracer::make(program->trees()[0]);
  EXPECT_TRUE(tracer) << tracer.why()[0].message;
  return std::move(*tracer);
}

/// All cells by themselves.
inline CrossingSearch traced(const TreeTracer& tracer, const Ray& ray) {
  CrossingSearch first;
  for (std::size_t cell = 0; cell < tracer.cell_count(); ++cell) {
    CellLog log;
    const auto hit = tracer.first_hit(cell, ray, false, log);
    first.undecided = std::min(first.undecided, log.undecided);
    first.evaluations += log.evaluations;
    if (hit && (!first.t || hit->t < *first.t)) first.t = hit->t;
  }
  return first;
}

}  // namespace marrow::test
