// The workloads are those of the common text files: the same random numbers, and the same skeletons to five decimals.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

#include "renderer/bench/python_random.h"
#include "renderer/bench/workload.h"
#include "renderer/scene/read_scene.h"

namespace marrow {
namespace {

// From python3: random.Random(867) and random.Random(10000).
TEST(PythonRandom, DrawsWhatPythonDraws) {
  PythonRandom first(867);
  for (const double expected : {0.8236000090728522, 0.7660468528643607, 0.6383201886638157})
    EXPECT_EQ(first.next(), expected);
  for (const int expected : {1, 0, 1, 1, 0, 1, 0, 1, 0, 1, 0, 1}) EXPECT_EQ(first.choose_second(), expected == 1);
  PythonRandom second(10000);
  for (int i = 0; i < 2000; ++i) second.next();  // past several refills of the state
  EXPECT_EQ(second.next(), 0.29629950710011477);
}

double sum_of_numbers(const Workload& w) {
  const auto sum = [](const Vec3d& p) { return p.x + p.y + p.z; };
  double total = 0;
  for (const auto& s : w.segments) total += sum(s.from) + sum(s.to) + s.radius_from + s.radius_to;
  for (const auto& p : w.points) total += sum(p.at) + p.radius;
  return total;
}

// The numbers of the text files that the peers read.
TEST(Workloads, AreThoseOfTheTextFiles) {
  const Workload w1 = creature(), w2 = hair(), w3 = balls();
  ASSERT_EQ(w1.segments.size(), 867u);
  ASSERT_EQ(w2.segments.size(), 10000u);
  ASSERT_EQ(w3.points.size(), 200u);
  EXPECT_EQ(w1.segments.front(), (SegmentSkeleton{{-1.55, -1.35, -.5}, {-1.48, -1.32656, -.44696}, .4, .40614}));
  EXPECT_EQ(w1.segments.back(), (SegmentSkeleton{{2.933, 2.72914, .6271}, {3.11607, 3.10675, .53613}, .0795, .03}));
  EXPECT_EQ(w2.segments.front(), (SegmentSkeleton{{.08047, 2.69784, 0}, {.0602, 2.8966, .02973}, .04, .0395}));
  EXPECT_EQ(w2.segments.back(),
            (SegmentSkeleton{{-1.67715, -3.04055, -1.04554}, {-1.82748, -3.23761, -.99472}, .0305, .03}));
  EXPECT_EQ(w3.points.back(), (PointSkeleton{{-2.66379, 2.0815, -1.3873}, .35384}));
  EXPECT_NEAR(sum_of_numbers(w1), 1609.52908, 1e-6);
  EXPECT_NEAR(sum_of_numbers(w2), 7556.93778, 1e-6);
  EXPECT_NEAR(sum_of_numbers(w3), 56.78310, 1e-6);
}

TEST(Workloads, HaveNames) {
  for (const auto& name : workload_names()) {
    const auto w = workload_named(name);
    ASSERT_TRUE(w);
    EXPECT_EQ(w->name, name);
  }
  EXPECT_FALSE(workload_named("w4"));
}

// The sum of the strands' shadows does not grow with their number.
TEST(Workloads, StrandsKeepTheirCoverage) {
  const auto shadow = [](const Workload& w) {
    double sum = 0;
    for (const auto& s : w.segments) sum += length(s.to - s.from) * (s.radius_from + s.radius_to);
    return sum;
  };
  const Workload few = strands(1000), many = strands(10000);
  EXPECT_EQ(few.segments.size(), 1000u);
  EXPECT_EQ(many.segments.size(), 10000u);
  EXPECT_NEAR(shadow(many) / shadow(few), 1, 0.05);
}

TEST(Workloads, PlacedBodiesFlatten) {
  const Workload w = tufts(3000), flat = w.flattened();
  EXPECT_EQ(w.segments.size(), 1000u);
  EXPECT_EQ(w.places.size(), 3u);
  EXPECT_EQ(w.size(), 3000u);
  EXPECT_EQ(flat.segments.size(), 3000u);
  EXPECT_EQ(flat.segments[2000].from, w.segments[0].from + w.places[2]);
  EXPECT_LT(length(flat.bounds().lower - w.bounds().lower), 1e-12);
  EXPECT_LT(length(flat.bounds().upper - w.bounds().upper), 1e-12);
}

// The scene's camera stands where the frame's eye does, and looks where it looks: along -z.
TEST(Workloads, AreSeenAlikeInScenes) {
  const auto folder = std::filesystem::temp_directory_path() / ("marrow-views-" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  for (const double z : {20.0, 1.0, 0.5, 1e-300, 0.0, -0.1, -20.0, 1e15, -1e13 - 1, 123456789012.0, -123456789012.0}) {
    Workload w = balls();
    w.eye = {-.1, 1.0 / 3, z};
    const auto path = folder / "view.yaml";
    ASSERT_TRUE(write_scene(w, 16, path));
    const auto scene = read_scene(path, {});
    ASSERT_TRUE(scene) << scene.why().front().message;
    EXPECT_EQ(scene->camera.from, w.eye);
    EXPECT_EQ(normalize(scene->camera.to - scene->camera.from).vec(), (Vec3d{0, 0, -1})) << z;
    EXPECT_NEAR(scene->camera.fov_deg, w.fov_deg(), 1e-8);
  }
  std::filesystem::remove_all(folder);
}

TEST(Workloads, BecomeScenes) {
  const auto folder = std::filesystem::temp_directory_path() / ("marrow-workloads-" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  const auto text_of = [&](const char* name) {
    std::ifstream in(folder / name);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  ASSERT_TRUE(write_scene(balls(), 64, folder / "w3.yaml"));
  EXPECT_NE(text_of("w3.yaml").find("- point: {at: [-2.66379, 2.0815, -1.3873], radius: 0.35384}"), std::string::npos);
  EXPECT_NE(text_of("w3.yaml").find("camera: {from: [0, 0, 20], to: [0, 0, 0], fov: 26."), std::string::npos);
  ASSERT_TRUE(write_scene(strands(20000), 64, folder / "many.yaml"));
  EXPECT_NE(text_of("many.yaml").find("file: many.swc"), std::string::npos);
  const std::string swc = text_of("many.swc");
  EXPECT_EQ(std::count(swc.begin(), swc.end(), '\n'), 21000);  // 1000 strands of 20 segments
  EXPECT_FALSE(write_scene(balls(), 64, folder / "no" / "such.yaml"));

  Workload placed = strands(20000);
  placed.places = {{1, 2, 3}};
  EXPECT_NE(scene_text(placed, 64, "body.swc").scene.find("translate: [1, 2, 3]"), std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace marrow
