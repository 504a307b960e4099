// Workloads of the peers' text and of skeleton files, and what is said of those that are wrong.
#include "renderer/bench/workload_reader.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace marrow {
namespace {

Workload read(const std::string& text, const std::string& name) {
  auto file = read_workload(text, name);
  EXPECT_TRUE(file) << file.why().front().message;
  return file ? std::move(file->workload) : Workload{};
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

// Numbers that no scene takes are told with their words, so that nothing is run that would not end well.
TEST(WorkloadReader, RefusesWhatScenesRefuse) {
  struct Case {
    const char* text;
    int column;
    const char* says;
  };
  for (const Case& c : {Case{"pt 1e20 0 0 1\n", 4, "`1e20`"},
                        {"pt 0 0 0 1e16\n", 10, "`1e16`"},
                        {"seg 0 0 0 1 0 -2e15 0 1\n", 15, "`-2e15`"},
                        {"pt 0 0 0 0\n", 10, "radius `0`"},
                        {"seg 0 0 0 1 1 0 0 1 -5\n", 21, "strength `-5`"},
                        {"pt 0 0 0 1 0\n", 12, "strength `0`"},
                        {"cam 0 0 9 1e9\n", 11, "`1e9`"},
                        {"cam 0 0 9 1e-9\n", 11, "`1e-9`"},
                        {"cam 0 0 -1e15 1\n", 9, "1e15"},
                        {"cam 1e16 0 0 1\n", 5, "`1e16`"}}) {
    const auto w = read_workload(std::string(c.text) + "pt 0 0 0 1\n", "a.txt");
    ASSERT_FALSE(w) << c.text;
    ASSERT_EQ(w.why().size(), 1u);
    const Diagnostic& d = w.why().front();
    EXPECT_EQ(d.where, (SourceLocation{"a.txt", 1, c.column})) << c.text;
    EXPECT_NE(d.message.find(c.says), std::string::npos) << d.message;
    EXPECT_FALSE(d.hint.empty());
  }
  EXPECT_FALSE(read_workload("pt 9e14 0 0 1\npt -9e14 0 0 1\n", "large.txt"));  // no eye could see all of it
  EXPECT_FALSE(read_workload("1 0 9e14 0 0 1 -1\n2 0 -9e14 0 0 1 1\n", "large.swc"));
  EXPECT_FALSE(read_workload("1 0 0 0 0 1 -1\n2 0 0 0 0 1 1\n", "nothing.swc"));
  EXPECT_EQ(read("light 1e-200 0 0\npt 0 0 0 1\n", "a.txt").toward_light, (Vec3d{1, 0, 0}));
}

TEST(WorkloadReader, HandsOnWarningsOfSkeletons) {
  const auto made = read_workload("1 0 0 0 0 0 -1\n2 0 2 0 0 1 1\n", "n.swc");
  ASSERT_TRUE(made);
  ASSERT_EQ(made->warnings.size(), 1u);
  EXPECT_EQ(made->warnings[0].severity, Severity::Warning);
  EXPECT_NE(made->warnings[0].message.find("radius 0"), std::string::npos);
  EXPECT_NE(made->warnings[0].hint.find("bench takes none"), std::string::npos);
  EXPECT_TRUE(read_workload("1 0 0 0 0 1 -1\n2 0 2 0 0 1 1\n", "n.swc")->warnings.empty());
  const auto wrong = read_workload("v 0 0 0\nv 1 0 0\nl 1 2\n", "a.obj");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.why().front().hint.find("bench takes none"), std::string::npos);
}

TEST(WorkloadReader, SaysWhatThereIs) {
  const std::string seg = "seg 0 0 0 1 1 0 0 1\n", pt = "pt 0 0 0 1\n";
  EXPECT_EQ(read(pt, "a/one.txt").about, "1 point of one.txt");
  EXPECT_EQ(read(seg + seg, "two.txt").about, "2 segments of two.txt");
  EXPECT_EQ(read(seg + pt + pt, "b.txt").about, "1 segment and 2 points of b.txt");
}

TEST(WorkloadReader, KnowsFilesByTheirEndings) {
  for (const char* name : {"a.txt", "a.TXT", "a.swc", "b/c.OBJ"}) EXPECT_TRUE(is_workload_file(name));
  // Those that are told of are those that are taken
  std::string words(workload_endings);
  std::ranges::replace(words, ',', ' ');
  std::istringstream all(words);
  int count = 0;
  for (std::string word; all >> word;) {
    if (word == "and") continue;
    EXPECT_TRUE(is_workload_file("a" + word)) << word;
    ++count;
  }
  EXPECT_EQ(count, 10);
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
