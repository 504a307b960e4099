// The peers answer: the limit is a union of round cones, and the loops count what they ask.
#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include "renderer/bench/frames.h"
#include "renderer/bench/ray_engine.h"

namespace marrow {
namespace {

Workload one_of_each() {
  Workload w{.name = "test",
             .about = {},
             .eye = {0, 0, 20},
             .tan_half_fov = 0.2,
             .toward_light = {0, 0, 1},
             .segments = {},
             .points = {},
             .places = {}};
  w.segments.push_back({{-2, 0, 0}, {-1, 0, 0}, 0.5, 0.5});
  w.points.push_back({{2, 0, 0}, 1});
  return w;
}

TEST(EmbreeEngine, MeetsConesAndSpheres) {
  const auto engine = embree_round_cones(one_of_each(), 1);
  ASSERT_TRUE(engine);
  const UnitVec3 down = UnitVec3::unchecked({0, 0, -1});
  EngineHit hit;
  RayCounts counts;
  ASSERT_TRUE(engine->first_hit({{-1.5, 0, 20}, down}, hit, counts));
  EXPECT_NEAR(hit.position.z, 0.5, 1e-5);
  ASSERT_TRUE(engine->first_hit({{2, 0.6, 20}, down}, hit, counts));
  EXPECT_NEAR(hit.position.z, 0.8, 1e-5);
  EXPECT_NEAR(hit.normal.y(), 0.6, 1e-4);
  EXPECT_FALSE(engine->first_hit({{0.5, 0, 20}, down}, hit, counts));
  EXPECT_TRUE(engine->occluded({{-1.5, 0, 20}, down}));
  EXPECT_FALSE(engine->occluded({{0.5, 0, 20}, down}));
}

TEST(Frames, CountRays) {
  const auto engine = embree_round_cones(one_of_each(), 1);
  ASSERT_TRUE(engine);
  const FrameSettings settings{64, 2};
  const RayCounts frame = shaded_frame(*engine, one_of_each(), settings);
  EXPECT_EQ(frame.rays, 64u * 64u);
  // Areas of the shadows over that of the picture, 8 x 8 at the skeletons' distance
  EXPECT_NEAR(static_cast<double>(frame.hits) / 4096, (3.1416 + 1 + 0.7854) / 64, 0.01);
  EXPECT_LE(frame.shadow_rays, frame.hits);
  const auto hits = hits_of_frame(*engine, one_of_each(), settings);
  EXPECT_EQ(hits.size(), frame.hits);
  const RayCounts paths = diffuse_paths(*engine, hits, 4, settings);
  EXPECT_GE(paths.rays, 4 * frame.hits);
  EXPECT_LE(paths.rays, 16 * frame.hits);
  EXPECT_EQ(diffuse_paths(*engine, hits, 4, {64, 1}).rays, paths.rays);
}

// Of which blocks of 4 x 4 pixels stick out.
TEST(Frames, OfAnySizeAskForEachPixelOnce) {
  const auto engine = embree_round_cones(one_of_each(), 1);
  ASSERT_TRUE(engine);
  for (const int size : {1, 30, 47}) {
    const RayCounts frame = shaded_frame(*engine, one_of_each(), {size, 2});
    EXPECT_EQ(frame.rays, static_cast<std::uint64_t>(size) * static_cast<std::uint64_t>(size));
    EXPECT_EQ(frame.hits, hits_of_frame(*engine, one_of_each(), {size, 1}).size());
  }
}

TEST(Frames, AskForNothingMoreAfterAStop) {
  const auto engine = embree_round_cones(one_of_each(), 1);
  ASSERT_TRUE(engine);
  const auto hits = hits_of_frame(*engine, one_of_each(), {64, 2});
  const std::atomic<bool> flag = true;
  const FrameSettings stopped{64, 2, {&flag}};
  EXPECT_EQ(shaded_frame(*engine, one_of_each(), stopped).rays, 0u);
  EXPECT_TRUE(hits_of_frame(*engine, one_of_each(), stopped).empty());
  EXPECT_EQ(diffuse_paths(*engine, hits, 4, stopped).rays, 0u);
}

TEST(EmbreeEngine, MeetsTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const auto engine = embree_triangles(mesh, 1e-3, 1);
  ASSERT_TRUE(engine);
  EngineHit hit;
  RayCounts counts;
  ASSERT_TRUE(engine->first_hit({{0.2, 0.2, 5}, UnitVec3::unchecked({0, 0, -1})}, hit, counts));
  EXPECT_NEAR(hit.position.z, 0, 1e-6);
  EXPECT_NEAR(hit.normal.z(), 1, 1e-6);
}

}  // namespace
}  // namespace marrow
