// Trees that are deep, wide or shared, on a stack of 256 KiB.
#include <functional>

#include <gtest/gtest.h>
#include <pthread.h>

#include "field/program/field_program.h"
#include "field/tree/any_node.h"

namespace marrow {
namespace {

constexpr std::size_t million = 1'000'000;

void on_a_small_stack(std::function<void()> work) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, 256 * 1024), 0);
  pthread_t thread;
  const auto run = [](void* f) -> void* {
    (*static_cast<std::function<void()>*>(f))();
    return nullptr;
  };
  ASSERT_EQ(pthread_create(&thread, &attributes, run, &work), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

FieldNodeId general(FieldDescription& field, AnyNode node, std::vector<FieldNodeId> of) {
  FieldNode made;
  made.what.emplace<GeneralNode>(boxed(std::move(node)), std::move(of));
  return field.add(std::move(made));
}

FieldNodeId ball_at(FieldDescription& field, double x) {
  Sphere s;
  s.center = {x, 0, 0};
  s.radius = 0.25;
  s.potential = WyvillProfile{0.2};
  return general(field, s, {});
}

// The field of a chain or a row of balls, one at each whole number below a million.
void expect_balls(const FieldDescription& field) {
  const auto program = compile(field);
  ASSERT_TRUE(program) << program.why()[0].message;
  EXPECT_NEAR(value(*program, {500'000.25, 0, 0}), 1, 1e-9);
  EXPECT_GT(value(*program, {999'999.0, 0, 0}), 1.9);
  EXPECT_EQ(value(*program, {0.5, 0, 0}), 0);
  EXPECT_LT(evaluate(*program, {3.25, 0, 0}).gradient.x, -1) << "it falls outward";
}

TEST(Machine, TreesMayBeAMillionDeep) {
  on_a_small_stack([] {
    FieldDescription field;
    FieldNodeId rest = ball_at(field, 0);
    for (std::size_t i = 1; i < million; ++i) {
      const FieldNodeId one = ball_at(field, static_cast<double>(i));
      rest = general(field, Ricci{3}, {rest, one});
    }
    field.root = rest;
    expect_balls(field);
  });
}

TEST(Machine, TreesMayBeAMillionWide) {
  on_a_small_stack([] {
    FieldDescription field;
    std::vector<FieldNodeId> all;
    for (std::size_t i = 0; i < million; ++i) all.push_back(ball_at(field, static_cast<double>(i)));
    field.root = general(field, Ricci{3}, std::move(all));
    expect_balls(field);
  });
}

// Twice the same child, twenty times over: a million paths through twenty nodes.
TEST(Machine, SharedChildrenAreHeldOnce) {
  FieldDescription field;
  FieldNodeId below = ball_at(field, 0);
  for (int i = 0; i < 18; ++i) {
    const FieldNodeId moved =
        field.add({.what = Transform{Affine::translate({double(1 << i), 0, 0}), below}, .where = {}});
    below = general(field, Ricci{3}, {below, moved});
  }
  field.root = below;
  const auto program = compile(field);
  ASSERT_TRUE(program) << program.why()[0].message;
  EXPECT_LE(program->trees()[0].records().size(), 40u);
  EXPECT_NEAR(value(*program, {131'072.25, 0, 0}), 1, 1e-9);
  EXPECT_EQ(value(*program, {131'072.5, 0, 0}), 0);
}

}  // namespace
}  // namespace marrow
