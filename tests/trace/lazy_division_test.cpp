// Dividing on demand: the same cells whoever asks first, and no more than there must be, whatever the scales.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include <gtest/gtest.h>

#include "field/blend/angle/contact.h"
#include "tests/trace/all_cells.h"
#include "tests/trace/first_of_tiles.h"
#include "tests/trace/stage.h"

namespace marrow::test {
namespace {

using CellKey = std::tuple<double, double, double, double>;

std::vector<CellKey> sorted(const std::vector<CellTree::Cell>& cells) {
  std::vector<CellKey> keys;
  for (const CellTree::Cell& c : cells) keys.emplace_back(c.center.x, c.center.y, c.center.z, c.half);
  std::sort(keys.begin(), keys.end());
  return keys;
}

void expect_same(const Surroundings& a, const Surroundings& b) {
  EXPECT_EQ(a.far.f, b.far.f);
  EXPECT_EQ(a.far.potential, b.far.potential);
  EXPECT_EQ(a.far.f_error, b.far.f_error);
  ASSERT_EQ(a.near.size(), b.near.size());
  for (std::size_t i = 0; i < a.near.size(); ++i) EXPECT_EQ(a.near[i].index(), b.near[i].index());
}

TEST(LazyDivision, DoesNotDependOnWhoAsksFirst) {
  Random random(71);
  for (int i = 0; i < 6; ++i) {
    const BlendField blend = random_scene(random, {4, contact_alpha(4)}, random.whole(2, 9));
    const Stage forward(blend), backward(blend);
    for (std::size_t k = backward.tree.tile_count(); k-- > 0;) backward.tree.tile(k);
    const auto cells = backward.tree.cells();
    ASSERT_EQ(sorted(forward.cells), sorted(cells));
    // Fine sources come from the tiles above: asked for from the last cell to the first, they are the same.
    for (std::size_t k = cells.size(); k-- > 0;)
      if (k % 7 == 0) expect_same(backward.tree.surroundings(cells[k]), forward.tree.surroundings(forward.cells[k]));
  }
}

TEST(LazyDivision, CellsAreDisjointAndOfTheirTiles) {
  Random random(72);
  const Stage stage(random_scene(random, {4, contact_alpha(4)}, 9));
  for (std::size_t i = 0; i < stage.cells.size(); i += 5) {
    const CellTree::Cell& c = stage.cells[i];
    std::size_t holding = 0;
    for (std::size_t t = 0; t < stage.tree.tile_count(); ++t) {
      if (!stage.tree.tile_box(t).contains(c.center)) continue;
      ++holding;
      const CellTree::Cell found = stage.tree.nearest_cell(t, c.center);
      EXPECT_EQ(found.center, c.center);
      EXPECT_EQ(found.half, c.half);
    }
    EXPECT_EQ(holding, 1U);
    const auto holds = [&](const CellTree::Cell& o) {
      return max_component(abs(o.center - c.center)) < (o.half + c.half) * (1 - 1e-9);
    };
    EXPECT_EQ(std::count_if(stage.cells.begin(), stage.cells.end(), holds), 1);
  }
}

// The plain sum of N coincident points of radius 1 has its surface at N^(1/(n-1)).
TEST(LazyDivision, ManySourcesAtOnePlace) {
  for (const int count : {1, 1000, 30'000}) {
    BlendField blend;
    blend.degree = 4;
    blend.alpha = std::numbers::pi / 2;
    for (int i = 0; i < count; ++i) blend.points.add({{0.1, 0.2, 0.3}, 1}, {});
    auto made = BlendTracer::make(blend, {});
    ASSERT_TRUE(made);
    const double radius = std::cbrt(static_cast<double>(count));
    const Ray ray{Vec3d{0.1, 0.2, 0.3} + Vec3d{0, 0, 4 * radius}, UnitVec3::unchecked({0, 0, -1})};
    const auto first = first_hit(**made, ray);
    ASSERT_TRUE(first) << count;
    EXPECT_NEAR(*first, 3 * radius, 2e-5 * radius) << count;
    EXPECT_LT((*made)->statistics().cells, 20'000U);
  }
}

// Radii from 1e-4 to 1e4 in one blend, each seen by a ray of its own.
TEST(LazyDivision, RadiiOfEightOrdersOfMagnitude) {
  BlendField blend;
  blend.degree = 4;
  blend.alpha = contact_alpha(4);
  for (const double r : {1e-4, 1e-2, 1.0, 1e2, 1e4}) blend.points.add({{0, 30 * r, 0}, r}, {});
  auto made = BlendTracer::make(blend, {});
  ASSERT_TRUE(made);
  for (const PointSkeleton& p : blend.points.skeletons) {
    const Ray ray{p.at + Vec3d{0, 0, 3 * p.radius}, UnitVec3::unchecked({0, 0, -1})};
    const auto first = first_hit(**made, ray);
    ASSERT_TRUE(first) << p.radius;
    // Others add a little to the field, so the surface is a little outside of the ball.
    EXPECT_NEAR(*first, 2 * p.radius, 0.1 * p.radius) << p.radius;
    EXPECT_NEAR(corrected_value(blend, ray.at(*first)), 1, 1e-4) << p.radius;
  }
  EXPECT_LT((*made)->tile_count(), 5'000U);
}

// Beside a small ball the weight of a large one, as a power of its radius in the cells of the small one, is beyond
// float.
TEST(LazyDivision, HighDegreesBesideSmallRadii) {
  for (const int degree : {8, 12, 20})
    for (const double small : {1e-2, 1e-3, 1e-4}) {
      BlendField blend;
      blend.degree = degree;
      blend.alpha = contact_alpha(degree);
      blend.points.add({{0, 0, 0}, 1}, {});
      blend.segments.add({{-1, 0, 0}, {1, 0, 0}, 0.8, 0.8}, {});
      blend.points.add({{0, 1.6, 0}, small}, {});
      auto made = BlendTracer::make(blend, {});
      ASSERT_TRUE(made);
      const Ray ray{{0, 1.6, 3}, UnitVec3::unchecked({0, 0, -1})};
      const auto first = first_hit(**made, ray);
      ASSERT_TRUE(first) << degree << ", " << small;
      EXPECT_NEAR(*first, 3 - small, 0.2 * small) << degree;
      EXPECT_NEAR(corrected_value(blend, ray.at(*first)), 1, 1e-4) << degree;
    }
}

TEST(LazyDivision, OfOneSegmentAnywhere) {
  for (const double size : {1e-4, 1.0, 1e4})
    for (const double away : {0.0, 1e3}) {
      BlendField blend;
      blend.degree = 4;
      blend.alpha = contact_alpha(4);
      const Vec3d at{away * size, -away * size, away * size};
      blend.segments.add({at, at + Vec3d{3 * size, 0, 0}, size, size / 2}, {});
      EXPECT_LT(Stage(blend).cells.size(), 4000U) << size << ' ' << away;
    }
}

}  // namespace
}  // namespace marrow::test
