// Cut and changed files of every format: each gives a skeleton that holds together, or an error, and soon.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/scene/skeleton_file_text.h"

namespace marrow {
namespace {

std::string small_hair() {
  std::string text = "HAIR";
  const auto number = [&](std::uint32_t n, int bytes) {
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(n >> 8 * i & 0xFF);
  };
  for (const std::uint32_t n : {3u, 9u, 7u, 2u, 0x3c23d70au}) number(n, 4);
  text.resize(128);
  for (int i = 0; i < 3; ++i) number(2, 2);
  for (std::uint32_t i = 0; i < 36; ++i) number(0x3f800000u + (i << 16), 4);
  return text;
}

struct Sample {
  SkeletonFormat format;
  std::string text;
  SkeletonOptions options;
};

std::vector<Sample> samples() {
  const CsvColumns parents{.x = 2, .y = 3, .z = 4, .radius = 5, .id = 1, .parent = 6};
  return {
      {SkeletonFormat::Swc, "# c\n1 1 0 0 0 1 -1\n2 1 1 0 0 0.5 1\n3 1 2 0 0.5 0.2 2\n4 1 3 0 0 0 2\n", {}},
      {SkeletonFormat::Obj, "# c\nv 0 0 0 1\nv 1 0 0 1\nv 1 1 0.5 0.1\nl 1 2 3 1\nl -1 \\\n -2\np 3\nf 1 2 3\n", {}},
      {SkeletonFormat::Csv, "strand,x,y,z,radius\na,0,0,0,1\na,1,0,0,.5\n\"b\",0,1e1,0,1\na,2,0,0,1\n", {}},
      {SkeletonFormat::Csv, "1;0,5;0;0;1;-1\n2;1;0;0;1;1\n3;2;0;0;1;2\n4;2;1;0;1;2\n", {.columns = parents}},
      {SkeletonFormat::Xyz,
       "4\nProperties=species:S:1:pos:R:3\nC 0 0 0\nO 1.2 0 0\nH 0 1 0\nFe 0 0 -2\n",
       {.bonds = 0.1}},
      {SkeletonFormat::Pdb,
       "ATOM      1  N   THR A   1      17.047  14.099   3.625  1.00 13.79           N\n"
       "ATOM      2  CA ATHR A   1      16.967  12.784   4.338  1.00 10.80           C\n"
       "ENDMDL\nCONECT    1    2\n",
       {.bonds = 0.1, .elements = {"C", "N"}}},
      {SkeletonFormat::CyHair, small_hair(), {}},
  };
}

// What compile() demands of a skeleton.
bool holds_together(const SkeletonGraph& graph) {
  const std::size_t count = graph.positions.size();
  if (count == 0 || graph.radii.size() != count || graph.parents.size() != count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t parent = graph.parents[i];
    const bool is_linked =
        parent >= -1 && parent < static_cast<std::int32_t>(count) && parent != static_cast<std::int32_t>(i);
    if (!is_linked || !(graph.radii[i] > 0) || !std::isfinite(graph.radii[i]) || !is_finite(graph.positions[i]))
      return false;
  }
  return true;
}

// Some, but not too many, in the order of the text, with all their lines.
bool can_be_told(const Diagnostics& why, const std::string& text) {
  if (why.empty() || why.size() > 20) return false;
  for (const Diagnostic& d : why) render(d, text);
  return std::ranges::is_sorted(why, {}, [](const Diagnostic& d) { return std::pair(d.where.line, d.where.column); });
}

std::string mutant(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  const char* const pieces[] = {"nan", "1e999", "-1", "99999999999", "\n", "\r", ",",          "\"",   "#",
                                "\\",  " ",     "0",  "\t",          "l ", "v ", "4294967295", "1e15", "\xEF\xBB\xBF",
                                ";",   "-"};
  for (std::size_t i = 0, changes = 1 + below(4); i < changes && !text.empty(); ++i) {
    const std::size_t at = below(text.size());
    switch (below(5)) {
      case 0:
        text.resize(at);
        break;
      case 1:
        text[at] = static_cast<char>(random());
        break;
      case 2:
        text.erase(at, 1 + below(8));
        break;
      case 3:
        text.insert(at, pieces[below(std::size(pieces))]);
        break;
      default:
        text.insert(at, text.substr(below(text.size()), below(40)));
    }
  }
  return text;
}

TEST(SkeletonFiles, SurviveMutation) {
  const unsigned seed = 11;
  RecordProperty("seed", static_cast<int>(seed));
  std::mt19937 random(seed);
  std::size_t good = 0, bad = 0;
  for (const Sample& sample : samples()) {
    ASSERT_TRUE(holds_together(read_good_file(sample.format, sample.text, sample.options).graph));
    for (int i = 0; i < 4000; ++i) {
      const std::string text = mutant(sample.text, random);
      const auto file = read_skeleton(sample.format, text, sample.options, "t");
      ++(file ? good : bad);
      if (file) ASSERT_TRUE(holds_together(file->graph)) << "seed " << seed << "\n" << text;
      else ASSERT_TRUE(can_be_told(file.why(), text)) << "seed " << seed << "\n" << text;
    }
  }
  EXPECT_GT(good, 2000u);  // the mutations are neither all harmless nor all deadly
  EXPECT_GT(bad, 2000u);
}

TEST(SkeletonFiles, SurviveEveryCut) {
  for (const Sample& sample : samples())
    for (std::size_t size = 0; size < sample.text.size(); ++size) {
      const auto file =
          read_skeleton(sample.format, std::string_view(sample.text).substr(0, size), sample.options, "t");
      if (file) ASSERT_TRUE(holds_together(file->graph)) << size;
      else ASSERT_FALSE(file.why().empty());
    }
}

TEST(SkeletonFiles, AreReadByAnyReaderWithoutHarm) {
  for (const Sample& sample : samples())
    for (int format = 0; format < 6; ++format) {
      const auto file = read_skeleton(static_cast<SkeletonFormat>(format), sample.text, {}, "t");
      EXPECT_TRUE(!file || holds_together(file->graph));
    }
}

using Row = std::array<char, 160>;
struct Large {
  const char* name;
  SkeletonFormat format;
  const char* head;
  int (*write)(Row&, int);  ///< row i, from 1; returns its length
};

const Large large_files[] = {
    {"obj", SkeletonFormat::Obj, "",
     [](Row& row, int i) {
       return std::snprintf(row.data(), row.size(), "v %.5f %.5f %.5f 0.25\nl %d %d\n", i * 0.01234, i * -0.5, i * 1e-4,
                            i, i > 1 ? i - 1 : 2);
     }},
    {"csv with strands", SkeletonFormat::Csv, "strand,x,y,z,radius\n",
     [](Row& row, int i) {
       return std::snprintf(row.data(), row.size(), "s%d,%.5f,%.5f,%.5f,0.25\n", i / 20, i * 0.01234, i * -0.5,
                            i * 1e-4);
     }},
    {"csv with parents", SkeletonFormat::Csv, "id,x,y,z,radius,parent\n",
     [](Row& row, int i) {
       return std::snprintf(row.data(), row.size(), "%d,%.5f,%.5f,%.5f,0.25,%d\n", i, i * 0.01234, i * -0.5, i * 1e-4,
                            i - 1);
     }},
    {"xyz", SkeletonFormat::Xyz, "1000000\n\n",
     [](Row& row, int i) {
       return std::snprintf(row.data(), row.size(), "C %.5f %.5f %.5f\n", i * 0.01234, i * -0.5, i * 1e-4);
     }},
    {"pdb", SkeletonFormat::Pdb, "",
     [](Row& row, int i) {
       return std::snprintf(row.data(), row.size(),
                            "ATOM  %5d  CA  RES A%4d    %8.3f%8.3f%8.3f  1.00  0.00           C\n", i % 100000,
                            i % 10000, i * 1e-3, i * -5e-4, i * 1e-4);
     }},
};

// One second is the aim for each; a busy machine is forgiven.
TEST(SkeletonFiles, OfAMillionRowsLoadInASecond) {
  for (const Large& file : large_files) {
    std::string text = file.head;
    text.reserve(90'000'000);
    Row row;
    for (int i = 1; i <= 1'000'000; ++i) text.append(row.data(), static_cast<std::size_t>(file.write(row, i)));
    const auto start = std::chrono::steady_clock::now();
    const auto made = read_skeleton(file.format, text, {}, "t");
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    ASSERT_TRUE(made) << file.name << made.why()[0].message;
    EXPECT_GE(made->graph.positions.size(), 1'000'000u);
    std::printf("10^6 rows of %s, %.1f MB: %.3f s\n", file.name, static_cast<double>(text.size()) * 1e-6,
                seconds.count());
    EXPECT_LT(seconds.count(), 5);
  }
}

}  // namespace
}  // namespace marrow
