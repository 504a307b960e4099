// Cells cover the surface, and the space they leave out lies on one side of it.
#include "field/trace/cells/cell_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/trace/stage.h"

namespace marrow::test {
namespace {

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const int n : {3, 4, 5})
    for (const bool cavity : {true, false})
      for (const double alpha : {0.0, 0.4, contact_alpha(n, cavity), std::numbers::pi / 2, -0.4})
        if (cavity || alpha > 0) all.push_back({n, alpha, cavity});
  return all;
}

class Cells {
 public:
  explicit Cells(const Stage& stage) {
    for (const auto& c : stage.cells) {
      boxes_.push_back(c.box());
      bounds_.include(boxes_.back());
      smallest_ = std::min(smallest_, 2 * c.half);
    }
  }
  bool hold(const Vec3d& p) const {
    return bounds_.contains(p) &&
           std::any_of(boxes_.begin(), boxes_.end(), [&](const Box3& b) { return b.contains(p); });
  }
  const Box3& bounds() const { return bounds_; }
  double smallest() const { return smallest_; }

 private:
  std::vector<Box3> boxes_;
  Box3 bounds_;
  double smallest_ = 1e300;
};

TEST(CellTree, HoldsEverySurfacePoint) {
  Random random(51);
  std::size_t points = 0, cells = 0;
  for (const Setting& s : settings()) {
    const Stage stage(random_scene(random, s, random.whole(2, 9)));
    const Cells cover(stage);
    cells += stage.cells.size();
    for (int i = 0; i < 150; ++i) {
      // From a place inside outwards; the field may rise and fall on the way, any crossing will do.
      const auto& segment = stage.field.segments.skeletons.front();
      Vec3d in = lerp(segment.from, segment.to, random.between(0, 1)) + random.vector(1e-3);
      Vec3d out = in + random_direction(random) * random.between(0.5, 6);
      if (!(stage.value(in) > 1) || !(stage.value(out) < 1)) continue;
      for (int k = 0; k < 45; ++k) {
        const Vec3d middle = (in + out) * 0.5;
        (stage.value(middle) >= 1 ? in : out) = middle;
      }
      ++points;
      ASSERT_TRUE(cover.hold(in)) << name_of(s) << " at " << in.x << ' ' << in.y << ' ' << in.z;
    }
  }
  std::cout << "  " << points << " points, " << cells << " cells\n";
  EXPECT_GT(points, 2000U);
}

// Climbs (outside) or descends (inside) in the space without cells, by steps of a tenth of a cell.
struct Attack {
  const Stage& stage;
  const Cells& cells;
  double nearest_outside = 0, nearest_inside = 1e300;  // values of the field nearest to 1

  void run(Vec3d p, const Setting& s) {
    const bool outside = stage.value(p) < 1;
    for (int step = 0; step < 60 && !cells.hold(p); ++step) {
      const BlendSample sample = evaluate(stage.field, p);
      ASSERT_EQ(sample.corrected < 1, outside)
          << name_of(s) << " C=" << sample.corrected << " at " << p.x << ' ' << p.y << ' ' << p.z;
      if (outside) nearest_outside = std::max(nearest_outside, sample.corrected);
      else nearest_inside = std::min(nearest_inside, sample.corrected);
      const double slope = length(sample.corrected_gradient);
      if (!(slope > 0)) return;
      p += sample.corrected_gradient * ((outside ? 0.1 : -0.1) * cells.smallest() / slope);
    }
  }
};

// So thick that cells in its middle are dropped.
BlendField thick_scene(Random& random, const Setting& s) {
  BlendField blend = random_scene(random, s, 2);
  for (int i = 0; i < 60; ++i) blend.points.add({random.vector(0.7), random.between(0.2, 0.4)}, {});
  return blend;
}

TEST(CellTree, LeavesOutNoSurface) {
  Random random(52);
  std::size_t attacks = 0;
  double outside = 0, inside = 1e300;
  int scene = 0;
  for (const Setting& s : settings()) {
    const Stage stage(++scene % 3 == 0 ? thick_scene(random, s) : random_scene(random, s, random.whole(2, 9)));
    const Cells cover(stage);
    Attack attack{stage, cover};
    for (int i = 0; i < 200; ++i) {
      Vec3d p = random_in(random, cover.bounds().padded(0.3));
      const auto& segment = stage.field.segments.skeletons[static_cast<std::size_t>(i) % stage.field.segments.size()];
      if (i % 3 == 0) p = lerp(segment.from, segment.to, random.between(0, 1)) + random.vector(0.2);
      if (cover.hold(p)) continue;
      ++attacks;
      attack.run(p, s);
      if (HasFatalFailure()) return;
    }
    outside = std::max(outside, attack.nearest_outside);
    inside = std::min(inside, attack.nearest_inside);
  }
  std::cout << "  " << attacks << " attacks; outside up to " << outside << ", inside down to " << inside << '\n';
  EXPECT_GT(attacks, 1500U);
}

// Empty space costs nothing, however much of it there is.
TEST(CellTree, DoesNotFillTheSpaceBetween) {
  for (const double alpha : {-0.4, 0.0, 0.003, 1.1, std::numbers::pi / 2}) {
    BlendField blend;
    blend.degree = 4;
    blend.alpha = alpha;
    blend.points.add({{0, 0, 0}, 1}, {});
    blend.points.add({{300, 200, 100}, 1}, {});
    EXPECT_LT(Stage(blend).cells.size(), 400U) << alpha;
  }
}

TEST(CellTree, OfNothingIsEmpty) { EXPECT_TRUE(Stage(BlendField{}).cells.empty()); }

}  // namespace
}  // namespace marrow::test
