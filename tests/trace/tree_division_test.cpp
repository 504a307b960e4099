// How far space is divided for a general tree, by the rays of a camera: nothing but time and memory depends on it.
#include <cstddef>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "field/program/field_program.h"
#include "field/trace/general/tree_cell.h"
#include "field/trace/general/tree_tracer.h"
#include "field/tree/any_node.h"
#include "tests/trace/large_cells.h"
#include "tests/trace/traced_trees.h"

namespace marrow::test {
namespace {

TreeTracer seen_by(const FieldTree& tree, std::shared_ptr<const RaySpacing> rays) {
  auto tracer = TreeTracer::make(tree, TreeTracer::everywhere, {.lent = nullptr, .spacing = std::move(rays)});
  EXPECT_TRUE(tracer) << tracer.why()[0].message;
  return std::move(*tracer);
}

std::shared_ptr<const RaySpacing> rays_apart(double spacing, int samples) {
  return std::make_shared<const RaySpacing>(
      RaySpacing{.views = {{.eye = {0, 0, 8}, .constant = spacing}}, .samples = samples});
}

TEST(TreeDivision, LargerCellsHoldTheSameSurface) {
  Random random(47);
  int hits = 0;
  std::size_t fine_bytes = 0, coarse_bytes = 0;
  for (int scene = 0; scene < 30; ++scene) {
    const FieldTree tree = random_tree(random);
    const TreeTracer fine = seen_by(tree, nullptr), coarse = seen_by(tree, hardly_a_ray());
    for (int r = 0; r < 30; ++r) {
      const Vec3d from = normalize(random.vector(1)) * 8.0;
      const Ray ray{.origin = from, .direction = normalize(random.vector(1.2) - from)};
      const CrossingSearch expected = traced(fine, ray), found = traced(coarse, ray);
      if (expected.undecided < 1e300 || found.undecided < 1e300) continue;
      ASSERT_EQ(found.t.has_value(), expected.t.has_value()) << "scene " << scene << " ray " << r;
      if (!found.t) continue;
      ++hits;
      EXPECT_NEAR(*found.t, *expected.t, 1e-9) << "scene " << scene << " ray " << r;
    }
    fine_bytes += fine.bytes();
    coarse_bytes += coarse.bytes();
  }
  EXPECT_GT(hits, 200);
  EXPECT_LT(2 * coarse_bytes, fine_bytes);
}

TEST(TreeDivision, CellsAreSmallerWhereMoreSamplesCome) {
  Random random(48);
  std::size_t once = 0, often = 0, unknown = 0, sixteen = 0;
  for (int scene = 0; scene < 10; ++scene) {
    const FieldTree tree = random_tree(random);
    const auto bytes_after_rays = [&](int samples) {
      const TreeTracer tracer = seen_by(tree, rays_apart(0.2, samples));
      for (int r = 0; r < 100; ++r) {
        const Vec3d to{0.2 * (r % 10 - 4.5), 0.2 * (r / 10 - 4.5), 0};
        traced(tracer, {.origin = {0, 0, 8}, .direction = normalize(to - Vec3d{0, 0, 8})});
      }
      return tracer.bytes();
    };
    once += bytes_after_rays(1);
    sixteen += bytes_after_rays(16);
    unknown += bytes_after_rays(0);
    often += bytes_after_rays(1024);
  }
  EXPECT_LT(once, sixteen);
  EXPECT_EQ(unknown, sixteen);
  EXPECT_LT(sixteen, often);
}

// A hundred bodies, of which few are near any place: cells that few rays meet still leave out the others.
TEST(TreeDivision, ManyOperandsAreLeftOutWhereRaysAreFewToo) {
  Random random(2026112909);
  for (const AnyNode& operation : {AnyNode{SoftUnion{}}, AnyNode{Contact{}}}) {
    FieldDescription field;
    std::vector<FieldNodeId> bodies;
    for (int i = 0; i < 100; ++i) {
      const Vec3d at{1.6 * (i % 10 - 4.5), 1.6 * (i / 10 - 4.5), random.between(-0.2, 0.2)};
      Blend pair;
      for (const double side : {-0.3, 0.3}) {
        Primitive ball;
        ball.skeleton = PointSkeleton{at + Vec3d{side, 0, 0}, 0.3};
        pair.of.push_back(field.add({.what = ball, .where = {}}));
      }
      bodies.push_back(field.add({.what = pair, .where = {}}));
    }
    field.root = field.add({.what = GeneralNode{.node = boxed(operation), .of = bodies, .material = {}}, .where = {}});
    const auto program = compile(field);
    ASSERT_TRUE(program);
    const FieldTree& tree = program->trees()[0];
    const TreeDivision division{.lent = nullptr, .spacing = hardly_a_ray()};
    const auto root = TreeCell::root(tree, surface_bounds(tree), tree.root(), division);
    for (const FieldNodeId body : bodies) {
      const auto& ball = std::get<Primitive>(field[std::get<Blend>(field[body].what).of[0]].what);
      const Vec3d surface = std::get<PointSkeleton>(ball.skeleton).at + Vec3d{0, 0, 0.3};
      EXPECT_LE(root->leaf_at(surface).tree().records().size(), 9u) << info_of(operation).name;
    }
  }
}

}  // namespace
}  // namespace marrow::test
