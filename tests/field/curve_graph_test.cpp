// Laws of branches and of graphs of curves.
#include "field/skeleton/curve_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "field/skeleton/branches.h"
#include "field/skeleton/subdivision_curve.h"
#include "tests/field/random.h"

namespace marrow {
namespace {

using test::Random;

SkeletonGraph graph_of(std::vector<Vec3d> positions, std::vector<std::int32_t> parents) {
  SkeletonGraph graph{.positions = std::move(positions), .radii = {}, .parents = std::move(parents)};
  for (std::size_t i = 0; i < graph.positions.size(); ++i) graph.radii.push_back(0.1 + 0.01 * static_cast<double>(i));
  return graph;
}

// A forest with chains, forks, strands that begin where others pass, and balls.
SkeletonGraph random_forest(Random& random) {
  SkeletonGraph graph;
  const int count = random.whole(1, 40);
  for (int i = 0; i < count; ++i) {
    const double kind = random.between(0, 1);
    graph.positions.push_back(i > 0 && kind < 0.2 ? graph.positions[static_cast<std::size_t>(random.whole(0, i - 1))]
                                                  : random.vector(1));
    graph.radii.push_back(random.between(0.1, 0.5));
    graph.parents.push_back(i == 0 || kind > 0.85 ? -1 : kind > 0.4 ? i - 1 : random.whole(0, i - 1));
  }
  return graph;
}

// Segments as pairs of places in ascending order: what the field is a sum of.
using Segment = std::array<double, 8>;
std::vector<Segment> segments_of(const SkeletonGraph& graph) {
  std::vector<Segment> segments;
  const auto end = [&](std::size_t i) {
    const Vec3d& p = graph.positions[i];
    return std::array<double, 4>{p.x, p.y, p.z, graph.radii[i]};
  };
  for (std::size_t i = 0; i < graph.parents.size(); ++i) {
    if (graph.parents[i] < 0) continue;
    auto a = end(static_cast<std::size_t>(graph.parents[i])), b = end(i);
    if (std::equal(a.begin(), a.begin() + 3, b.begin())) continue;
    if (b < a) std::swap(a, b);
    segments.push_back({a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]});
  }
  std::sort(segments.begin(), segments.end());
  return segments;
}

double total_length(const SkeletonGraph& graph) {
  double sum = 0;
  for (const Segment& s : segments_of(graph)) sum += length(Vec3d{s[4] - s[0], s[5] - s[1], s[6] - s[2]});
  return sum;
}

TEST(Branches, EndAtJunctionsAndEnds) {
  // A fork at node 2, whose second arm begins with a node of its own at the same place.
  const SkeletonGraph graph = graph_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 0, 0}, {3, -1, 0}, {9, 9, 9}},
                                       {-1, 0, 1, 2, -1, 4, -1});
  const Branches branches = branches_of(graph);
  EXPECT_EQ(branches.paths.size(), 3u);
  EXPECT_EQ(branches.balls, (std::vector<std::int32_t>{6}));
  EXPECT_EQ(branches_of(graph, std::vector<std::int32_t>{1}).paths.size(), 4u);
}

TEST(Branches, CloseWhereTheLastNodeIsAtThePlaceOfTheFirst) {
  const Branches branches = branches_of(graph_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, {-1, 0, 1, 2}));
  ASSERT_EQ(branches.paths.size(), 1u);
  EXPECT_TRUE(branches.paths[0].is_closed);
  EXPECT_EQ(branches.nodes.size(), 3u);
}

TEST(CurveGraph, KeepsEverySegmentAtLevelZero) {
  Random random(71);
  for (int i = 0; i < 200; ++i) {
    SkeletonGraph graph = random_forest(random);
    std::fill(graph.radii.begin(), graph.radii.end(), 0.25);  // nodes at one place then agree
    const SkeletonGraph same = subdivide(graph, Subdivision::Chaikin, 0);
    ASSERT_EQ(segments_of(same), segments_of(graph)) << i;
    const auto lonely = [](const SkeletonGraph& g) { return branches_of(g).balls.size(); };
    ASSERT_EQ(lonely(same), lonely(graph)) << i;
  }
}

TEST(CurveGraph, OfAChainIsTheSubdivisionCurve) {
  Random random(72);
  for (const Subdivision mask : {Subdivision::Chaikin, Subdivision::Cubic}) {
    CurveSkeleton curve{.points = {}, .radii = {}, .subdivision = mask, .levels = 3, .sticking = {2}};
    SkeletonGraph chain;
    for (int i = 0; i < 6; ++i) {
      chain.positions.push_back(random.vector(1));
      chain.radii.push_back(random.between(0.1, 0.5));
      chain.parents.push_back(i - 1);
    }
    curve.points = chain.positions;
    curve.radii = chain.radii;
    const PolylineSkeleton line = subdivide(curve);
    const SkeletonGraph graph = subdivide(chain, mask, 3, std::vector<std::int32_t>{2});
    const auto has = [&](const Vec3d& p) {
      return std::find(graph.positions.begin(), graph.positions.end(), p) != graph.positions.end();
    };
    EXPECT_TRUE(std::all_of(line.points.begin(), line.points.end(), has));
    EXPECT_EQ(graph.positions.size(), line.points.size() + 1);  // the sticking joint ends two branches
  }
}

TEST(CurveGraph, KeepsJunctionsAndShortens) {
  Random random(73);
  for (int i = 0; i < 100; ++i) {
    const SkeletonGraph graph = random_forest(random);
    const SkeletonGraph smooth = subdivide(graph, i % 2 ? Subdivision::Chaikin : Subdivision::Cubic, 3);
    EXPECT_LE(total_length(smooth), total_length(graph) * (1 + 1e-12));
    const Branches branches = branches_of(graph);
    for (const Branches::Path& path : branches.paths) {
      if (path.is_closed) continue;
      const Vec3d end = graph.positions[static_cast<std::size_t>(branches.of(path).front())];
      ASSERT_NE(std::find(smooth.positions.begin(), smooth.positions.end(), end), smooth.positions.end()) << i;
    }
    for (std::size_t k = 0; k < smooth.radii.size(); ++k) ASSERT_TRUE(smooth.radii[k] >= 0.1 && smooth.radii[k] <= 0.5);
  }
}

// A regular polygon stays one: the same whatever joint it begins with, and near its inner circle.
TEST(CurveGraph, SmoothsAClosedCurveAllAround) {
  constexpr int corners = 8;
  SkeletonGraph polygon;
  for (int i = 0; i <= corners; ++i) {
    const double angle = 2 * 3.14159265358979323846 * (i % corners) / corners;
    polygon.positions.push_back({std::cos(angle), std::sin(angle), 0});
    polygon.radii.push_back(0.1);
    polygon.parents.push_back(i - 1);
  }
  for (const Subdivision mask : {Subdivision::Chaikin, Subdivision::Cubic}) {
    const SkeletonGraph ring = subdivide(polygon, mask, 4);
    EXPECT_EQ(ring.positions.size(), (corners << 4) + 1u);
    EXPECT_EQ(ring.positions.front(), ring.positions.back());
    double nearest = 2, farthest = 0;
    for (const Vec3d& p : ring.positions) {
      nearest = std::min(nearest, length(p));
      farthest = std::max(farthest, length(p));
    }
    EXPECT_GT(nearest, 0.88);
    EXPECT_LT(farthest / nearest, 1.02);
  }
}

TEST(CurveGraph, SimplifiesWithinTheTolerance) {
  Random random(74);
  SkeletonGraph wave;
  for (int i = 0; i <= 2000; ++i) {
    const double x = i * 0.01;
    wave.positions.push_back({x, std::sin(x), 0.001 * random.between(-1, 1)});
    wave.radii.push_back(0.2 + 0.1 * std::cos(0.5 * x));
    wave.parents.push_back(i - 1);
  }
  std::size_t before = wave.positions.size();
  for (const double tolerance : {0.002, 0.02, 0.2}) {
    const SkeletonGraph simple = simplify(wave, tolerance);
    EXPECT_LT(simple.positions.size(), before / 2);
    before = simple.positions.size();
    EXPECT_EQ(simple.positions.front(), wave.positions.front());
    EXPECT_EQ(simple.positions.back(), wave.positions.back());
    for (std::size_t i = 0; i < wave.positions.size(); ++i) {
      double least = 1e300;
      for (std::size_t k = 1; k < simple.positions.size(); ++k) {
        const Vec3d a = simple.positions[k - 1], ab = simple.positions[k] - a;
        const double t = std::clamp(dot(wave.positions[i] - a, ab) / length_squared(ab), 0.0, 1.0);
        const double radius = simple.radii[k - 1] + (simple.radii[k] - simple.radii[k - 1]) * t;
        least = std::min(least, std::max(length(wave.positions[i] - a - ab * t), std::fabs(wave.radii[i] - radius)));
      }
      ASSERT_LE(least, tolerance * (1 + 1e-12)) << i;
    }
  }
}

}  // namespace
}  // namespace marrow
