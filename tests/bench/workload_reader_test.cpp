// Workloads of the peers' text and of skeleton files, and what is said of those that are wrong.
#include "renderer/bench/workload_reader.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

namespace marrow {
namespace {

Workload read(const std::string& text, const std::string& name) {
  auto w = read_workload(text, name);
  EXPECT_TRUE(w) << w.why().front().message;
  return w ? std::move(*w) : Workload{};
}

TEST(WorkloadReader, ReadsThePeersText) {
  const Workload w = read(
      "# a comment\ncam 1 2 20 0.25\r\nlight 0 3 4\n\n"
      "seg 0 0 0 .5  1 0 0 .25  0.476 # strength\nseg 1 0 0 .25  1 1 0 .25\npt 3 0 0 1 1\n",
      "some folder/a b.txt");
  EXPECT_EQ(w.name, "a_b");
  EXPECT_EQ(w.eye, (Vec3d{1, 2, 20}));
  EXPECT_EQ(w.tan_half_fov, 0.25);
  EXPECT_EQ(w.toward_light, (Vec3d{0, 0.6, 0.8}));
  ASSERT_EQ(w.segments.size(), 2u);
  EXPECT_EQ(w.segments[0], (SegmentSkeleton{{0, 0, 0}, {1, 0, 0}, .5, .25}));
  ASSERT_EQ(w.points.size(), 1u);
  EXPECT_EQ(w.points[0], (PointSkeleton{{3, 0, 0}, 1}));
  EXPECT_EQ(w.thinnest_radius(), .25);
}

// All of it is in the picture: corners of the bounds within the angle of view, before the eye.
TEST(WorkloadReader, LooksAtAllOfASkeleton) {
  for (const double size : {1e-3, 1.0, 1e4}) {
    std::string text;
    for (const Vec3d& p : {Vec3d{1, 1, 1}, {4, 1, 1}, {4, 2, 1}, {4, 2, 9}})
      text += std::to_string(size * p.x) + " " + std::to_string(size * p.y) + " " + std::to_string(size * p.z) + " " +
              std::to_string(size * 0.1) + "\n";
    const Workload w = read("x y z radius\n" + text, "a.csv");
    EXPECT_EQ(w.size(), 4u);
    const Box3 box = w.bounds();
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d from_eye = Vec3d{corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                                   corner & 4 ? box.upper.z : box.lower.z} -
                             w.eye;
      EXPECT_LT(from_eye.z, 0);
      EXPECT_LE(std::max(std::abs(from_eye.x), std::abs(from_eye.y)), -from_eye.z * w.tan_half_fov);
    }
  }
}

// Of a branch that ends where it began one segment is left out; a root alone is a point.
TEST(WorkloadReader, ReadsSkeletons) {
  const Workload w = read("1 0 0 0 0 1 -1\n2 0 2 0 0 1 1\n3 0 2 0 0 1 2\n4 0 2 2 0 .5 3\n5 0 9 9 9 .5 -1\n", "n.SWC");
  EXPECT_EQ(w.name, "n");
  EXPECT_EQ(w.segments.size(), 2u);
  ASSERT_EQ(w.points.size(), 1u);
  EXPECT_EQ(w.points[0], (PointSkeleton{{9, 9, 9}, .5}));
}

TEST(WorkloadReader, TellsEveryMistake) {
  const auto w = read_workload(
      "cam 0 0 20 0.2\ncam 0 0 20 -1\nlight 0 0 0\nseg 0 0 0 1 0 0 0 1\nseg 1 2 3\npt 0 0 0 -1\npt 0 x 0 1\n"
      "pt 0 0 0 1 1 1\nsphere 0 0 0 1\n",
      "bad.txt");
  ASSERT_FALSE(w);
  std::vector<int> lines;
  for (const Diagnostic& d : w.why()) lines.push_back(d.where.line);
  EXPECT_EQ(lines, (std::vector{2, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(w.why()[6].where.column, 6);
  EXPECT_FALSE(read_workload("", "empty.txt"));
  EXPECT_FALSE(read_workload("", "empty.swc"));
}

TEST(WorkloadReader, KnowsFilesByTheirEndings) {
  for (const char* name : {"a.txt", "a.swc", "b/c.OBJ"}) EXPECT_TRUE(is_workload_file(name));
  for (const char* name : {"w1", "a.yaml", "txt"}) EXPECT_FALSE(is_workload_file(name));
}

// Points among so many segments that they stand in a file of their own.
TEST(WorkloadReader, PointsOfLargeWorkloadsAreWritten) {
  Workload w = strands(20'000);
  w.points.push_back({{0, 0, 9}, 0.5});
  const auto folder = std::filesystem::temp_directory_path() / ("marrow-reader-" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  ASSERT_TRUE(write_scene(w, 16, folder / "many.yaml"));
  std::ifstream file(folder / "many.swc");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const Workload again = read(text, "many.swc");
  EXPECT_EQ(again.points, w.points);
  EXPECT_EQ(again.segments.size(), w.segments.size());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace marrow
