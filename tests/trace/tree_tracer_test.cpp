// The tracer of general trees against dense sampling of the field along rays, over random trees of all kinds of nodes.
#include "field/trace/general/tree_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "field/number/interval.h"
#include "tests/trace/traced_trees.h"

namespace marrow::test {
namespace {

// The first change of side among samples, as an interval.
std::optional<Interval> sampled(const FieldTree& tree, const Ray& ray, double end) {
  constexpr int samples = 3000;
  bool inside = value(tree, ray.origin) >= 1;
  for (int i = 1; i <= samples; ++i) {
    const double t = end * i / samples;
    if ((value(tree, ray.at(t)) >= 1) != inside) return Interval{end * (i - 1) / samples, t};
  }
  return {};
}

TEST(TreeTracer, NeverComesAfterWhatSamplingFindsAndAlwaysLiesOnTheSurface) {
  Random random(41);
  int hits = 0, undecided = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const FieldTree tree = random_tree(random);
    const auto tracer = TreeTracer::make(tree);
    ASSERT_TRUE(tracer) << tracer.why()[0].message;
    for (int r = 0; r < 12; ++r) {
      const Vec3d from = normalize(random.vector(1)) * 8.0;
      const Ray ray{.origin = from, .direction = normalize(random.vector(1.2) - from)};
      const CrossingSearch found = traced(*tracer, ray);
      const auto expected = sampled(tree, ray, 16);
      undecided += found.undecided < 1e300;
      if (expected) {
        ASSERT_TRUE(found.t) << "scene " << scene << " ray " << r << " missed at " << expected->lo;
        EXPECT_LE(*found.t, expected->hi + 1e-9) << "scene " << scene << " ray " << r;
      }
      if (!found.t) continue;
      ++hits;
      const double before = value(tree, ray.at(*found.t - 1e-9)), after = value(tree, ray.at(*found.t + 1e-9));
      EXPECT_NE(before >= 1, after >= 1) << "scene " << scene << " ray " << r << ": " << before << " " << after;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_LE(undecided, 5);
}

// Below 0 the corrected field falls where the sum rises, is guarded far away, and has kinks at both.
FieldTree ball_and_negative_blend(Random& random) {
  FieldDescription field;
  Blend blend;
  for (int i = 0; i < 2; ++i) blend.of.push_back(field.add({.what = tube(random), .where = {}}));
  blend.alpha = random.between(-1, 0);
  blend.cavity = random.between(0, 1) < 0.7;
  const FieldNodeId tubes = field.add({.what = std::move(blend), .where = {}}), beside = ball(field, random);
  return tree_above(field, add(field, Sum{}, {tubes, beside}));
}

// Rays from 8 away to places within `reach`, against samples along them.
struct Tally {
  int hits = 0, undecided = 0, missed = 0;
  std::uint32_t evaluations = 0;

  void trace(const FieldTree& tree, Random& random, int rays, double reach) {
    const auto tracer = TreeTracer::make(tree);
    ASSERT_TRUE(tracer) << tracer.why()[0].message;
    for (int r = 0; r < rays; ++r) {
      const Vec3d from = normalize(random.vector(1)) * 8.0;
      const Ray ray{.origin = from, .direction = normalize(random.vector(reach) - from)};
      const CrossingSearch found = traced(*tracer, ray);
      const auto expected = sampled(tree, ray, 16);
      missed += expected && !(found.t && *found.t <= expected->hi + 1e-9);
      hits += found.t.has_value();
      undecided += found.undecided < Box3::inf;
      evaluations += found.evaluations;
    }
  }
  void tell(int rays) const {
    std::cout << "  " << hits << " hits, " << missed << " missed, " << undecided << " undecided, "
              << evaluations / static_cast<std::uint32_t>(rays) << " evaluations a ray\n";
  }
};

TEST(TreeTracer, DecidesBlendsOfNegativeAngles) {
  Random random(48);
  Tally tally;
  constexpr int scenes = 15, rays = 40;
  for (int scene = 0; scene < scenes; ++scene) tally.trace(ball_and_negative_blend(random), random, rays, 1.2);
  tally.tell(scenes * rays);
  EXPECT_GT(tally.hits, 100);
  EXPECT_EQ(tally.missed, 0);
  EXPECT_LE(tally.undecided, 1);
  EXPECT_LT(tally.evaluations, 200u * scenes * rays);
}

// The default support at the default degree, where the operator would bring whole volumes to f = 1 but for rounding.
TEST(TreeTracer, DecidesKernelsWhoseTopIsTheSurface) {
  Random random(49);
  Tally tally;
  constexpr int scenes = 20, rays = 30;
  for (int scene = 0; scene < scenes; ++scene) {
    FieldDescription field;
    Blend blend;
    blend.kernel = scene % 2 == 0 ? Kernel{KernelFamily::Compact, 4, 2} : Kernel{KernelFamily::Cauchy, 4, 0.5};
    if (scene % 4 < 2) blend.alpha = random.between(0, 1.5);
    for (int i = 0; i < 2; ++i) {
      Primitive one;
      one.skeleton = PointSkeleton{random.vector(0.6), random.between(0.5, 0.9)};
      blend.of.push_back(field.add({.what = one, .where = {}}));
    }
    tally.trace(tree_above(field, field.add({.what = std::move(blend), .where = {}})), random, rays, 0.8);
  }
  tally.tell(scenes * rays);
  EXPECT_GT(tally.hits, 300);
  EXPECT_EQ(tally.missed, 0);
  EXPECT_LE(tally.undecided, 10);  // silhouettes; C has a kink there
}

// A bend cuts space behind the centre of its circle: rays across the cut are decided all the same.
TEST(TreeTracer, DecidesRaysAcrossACut) {
  Random random(43);
  int hits = 0, rays = 0;
  for (int scene = 0; scene < 12; ++scene) {
    FieldDescription field;
    const FieldNodeId bar = add(field, Box{.size = {0.5, 3, 0.5}, .rounding = 0.05, .potential = {}});
    const Bend bend{.length = random.between(1, 3), .angle = random.between(1, 6)};
    field.root = add(field, bend, {bar});
    const auto program = compile(field);
    ASSERT_TRUE(program) << program.why()[0].message;
    const auto tracer = TreeTracer::make(program->trees()[0]);
    ASSERT_TRUE(tracer) << tracer.why()[0].message;
    const double radius = bend.length / bend.angle;
    for (int i = 0; i < 100; ++i, ++rays) {
      const Vec3d from = normalize(random.vector(1)) * 8.0;
      const Vec3d behind{radius + random.between(0, 2), random.between(-0.1, 0.1), random.between(-0.3, 0.3)};
      const Ray ray{.origin = from, .direction = normalize(behind - from)};
      const CrossingSearch found = traced(*tracer, ray);
      EXPECT_GT(found.undecided, 1e300) << "scene " << scene << " ray " << i;
      const auto expected = sampled(program->trees()[0], ray, 16);
      if (expected) { EXPECT_TRUE(found.t && *found.t <= expected->hi + 1e-9) << "scene " << scene << " ray " << i; }
      hits += found.t.has_value();
    }
  }
  EXPECT_GT(hits, rays / 20);
  EXPECT_LT(hits, rays);
}

// Two boxes with a face in common, or a hair between them: from inside one leaves only where there is an outside. Far
// from the origin places are rounded by more than sums are, and where fields are flat sums by more than places.
TEST(TreeTracer, GoesThroughACommonFaceButNotAcrossAGap) {
  Random random(44);
  for (const auto& [away, range] : {std::pair{0.0, 1.0}, {4.7e4, 1.0}, {0.0, 1e4}})
    for (const double gap : {0.0, 1e-16, 1e-6}) {
      FieldDescription field;
      const auto box = [&](double center, double size) {
        return add(field,
                   Box{.center = {away + center, 0, 0}, .size = {size, 2, 2}, .potential = WyvillProfile{range}});
      };
      field.root = field.add({.what = Union{{box(0, 2), box(1.75 + gap, 1.5)}}, .where = {}});
      const TreeTracer tracer = tracer_of(field);
      for (int i = 0; i < 60; ++i) {
        const Vec3d from{away + 0.3, random.between(-0.9, 0.9), random.between(-0.9, 0.9)};
        const Vec3d to{away + 2.4, random.between(-0.9, 0.9), random.between(-0.9, 0.9)};
        const Ray ray{.origin = from, .direction = normalize(to - from)};
        const CrossingSearch found = traced(tracer, ray);
        ASSERT_TRUE(found.t) << "gap " << gap;
        const double x = ray.at(*found.t).x - away;
        if (gap > 1e-15) EXPECT_NEAR(x, 1, 1e-12 + 1e-14 * away);
        else EXPECT_GT(x, 2.3) << "away " << away << " range " << range;
      }
    }
}

// Each box has an edge there, and the whole a plane.
TEST(TreeTracer, HasANormalWhereMembersMeet) {
  Random random(46);
  FieldDescription field;
  const FieldNodeId left = add(field, Box{.center = {}, .size = {1, 1, 1}, .potential = {}}),
                    right = add(field, Box{.center = {1, 0, 0}, .size = {1, 1, 1}, .potential = {}});
  field.root = field.add({.what = Union{{left, right}}, .where = {}});
  const TreeTracer tracer = tracer_of(field);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const double y = random.between(-0.4, 0.4), beside = i % 2 == 0 ? 0 : std::pow(10, random.between(-15, -9));
    const Vec3d to{0.5 + beside, y, 0.5};
    // Along the joint, aslant in its plane, or from anywhere.
    const Vec3d from = to + Vec3d{i % 3 == 2 ? random.between(-2, 2) : 0, i % 3 == 0 ? 0 : random.between(-2, 2), 5};
    const Ray ray{.origin = from, .direction = normalize(to - from)};
    for (std::size_t cell = 0; cell < tracer.cell_count(); ++cell) {
      CellLog log;
      const auto hit = tracer.first_hit(cell, ray, false, log);
      if (!hit || std::fabs(ray.at(hit->t).z - 0.5) > 1e-9) continue;
      ++hits;
      const SurfacePoint surface = tracer.surface_at(cell, ray.at(hit->t), ray.direction);
      EXPECT_GT(surface.normal.vec().z, 0.999) << "beside by " << beside << ", ray " << i;
    }
  }
  EXPECT_GT(hits, 300);
}

struct BoxAndBall {
  Affine turn;
  TreeTracer tracer;
};

// A box whose faces lie aslant, so that sums there are 1 but for rounding, and a ball around a place of one of them.
BoxAndBall box_and_ball(Random& random, const Vec3d& center, double radius) {
  const Affine turn = Affine::rotate(normalize(random.vector(1)), random.between(0.2, 3));
  FieldDescription field;
  const FieldNodeId box = add(field, Box{.center = {}, .size = {2, 1, 1.5}, .potential = {}});
  const FieldNodeId turned = field.add({.what = Transform{turn, box}, .where = {}});
  const FieldNodeId ball = add(field, Sphere{.center = turn.point(center), .radius = radius, .potential = {}});
  field.root = field.add({.what = Union{{turned, ball}}, .where = {}});
  return {turn, tracer_of(field)};
}

// A ray that runs in a face inside another body meets a crossing by rounding at every other place: they are passed in
// strides.
TEST(TreeTracer, PassesAFaceThatItRunsInInsideAnotherBody) {
  Random random(47);
  const Vec3d center{0.1, 0.5, -0.1};
  std::uint32_t evaluations = 0;
  for (const double radius : {0.15, 0.3, 0.6}) {
    for (int i = 0; i < 20; ++i) {
      const auto [turn, tracer] = box_and_ball(random, center, radius);
      const double angle = random.between(0, 6.3);
      const UnitVec3 along = normalize(turn.vector({std::cos(angle), 0, std::sin(angle)}));
      const CrossingSearch found = traced(tracer, {.origin = turn.point(center), .direction = along});
      ASSERT_TRUE(found.t);
      EXPECT_GT(*found.t, radius - 1e-6);
      evaluations = std::max(evaluations, found.evaluations);
    }
  }
  std::cout << "  at most " << evaluations << " evaluations\n";
  EXPECT_LT(evaluations, 5'000u);
}

// Where a body is inside another one it has no cells.
TEST(TreeTracer, HasNoCellsInsideAnotherBody) {
  Random random(48);
  const std::size_t of_ball = box_and_ball(random, {}, 3).tracer.cell_count();
  const std::size_t apart = box_and_ball(random, {10, 0, 0}, 3).tracer.cell_count();
  EXPECT_GT(of_ball, 0u);
  EXPECT_LT(of_ball, apart);
}

// A tube along z with another one across it.
FieldTree crossing_tubes(const Alpha& alpha, SkeletonModel model) {
  FieldDescription field;
  Blend blend;
  blend.alpha = alpha;
  blend.model = model;
  if (model == SkeletonModel::CaniHornus) blend.kernel.degree = 3;
  const auto tube = [&](const SegmentSkeleton& s) {
    Primitive one;
    one.skeleton = s;
    if (std::holds_alternative<AlphaPerSkeleton>(alpha)) one.alpha = -0.3;
    blend.of.push_back(field.add({.what = one, .where = {}}));
  };
  tube({{0, 0, -1}, {0, 0, 1}, 0.2, 0.2});
  tube({{-0.5, 0, 0.5}, {0.5, 0, 0.7}, 0.1, 0.05});
  return tree_above(field, field.add({.what = std::move(blend), .where = {}}));
}

// Around a skeleton a field has no upper bound; its lower one says that all of it is inside, however near the ray is.
TEST(TreeTracer, PassesAlongASkeletonInside) {
  struct Rule {
    Alpha alpha;
    SkeletonModel model;
  };
  const std::vector<Rule> rules{{-0.2, SkeletonModel::Integral},
                                {AlphaLocalContact{}, SkeletonModel::Integral},
                                {AlphaPerSkeleton{}, SkeletonModel::Integral},
                                {AlphaContact{}, SkeletonModel::CaniHornus}};
  std::uint32_t evaluations = 0;
  for (const auto& [alpha, model] : rules) {
    const auto tracer = TreeTracer::make(crossing_tubes(alpha, model));
    ASSERT_TRUE(tracer) << tracer.why()[0].message;
    for (const double beside : {1e-8, 1e-6, 1e-5, 1e-4}) {
      const Ray ray{.origin = {0, 0, -1.05}, .direction = normalize({beside, 0.3 * beside, 1})};
      const CrossingSearch found = traced(*tracer, ray);
      ASSERT_TRUE(found.t) << "rule " << alpha.index();
      EXPECT_GT(*found.t, 2);
      EXPECT_EQ(found.undecided, Box3::inf) << "rule " << alpha.index() << " at " << beside;
      evaluations = std::max(evaluations, found.evaluations);
    }
  }
  std::cout << "  at most " << evaluations << " evaluations\n";
  EXPECT_LT(evaluations, 1000u);
}

}  // namespace
}  // namespace marrow::test
