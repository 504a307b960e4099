// Curves and tables: OBJ, CSV, cyHair.
#include <bit>
#include <cstring>
#include <limits>

#include "tests/scene/skeleton_file_text.h"

namespace marrow {
namespace {

using Parents = std::vector<std::int32_t>;
using Radii = std::vector<double>;
constexpr auto obj = SkeletonFormat::Obj, csv = SkeletonFormat::Csv, hair = SkeletonFormat::CyHair;
const SkeletonOptions thick{.radius = 0.5};

TEST(SkeletonFormats, ComeFromTheEnding) {
  EXPECT_EQ(skeleton_format_of("a/b.SWC"), SkeletonFormat::Swc);
  EXPECT_EQ(skeleton_format_of("b.tsv"), csv);
  EXPECT_EQ(skeleton_format_of("pdb1crn.ent"), SkeletonFormat::Pdb);
  EXPECT_FALSE(skeleton_format_of("obj"));
  EXPECT_FALSE(skeleton_format_of("b.yaml"));
}

TEST(ObjLines, JoinVerticesHoweverTheyAreCounted) {
  const auto file = read_good_file(obj,
                                   "# two lines that meet\r\nv 0 0 0 0.1\r\nv 1 0 0 .2\r\nv 1 1 0 0.3\r\nl 1 2/7 -1\r\n"
                                   "f 1 2 3\r\nvn 0 0 1\r\nv 2 2 2 0.4\r\nl 2 \\\r\n 4\r\np 4\r\n");
  EXPECT_EQ(file.graph.parents, (Parents{-1, 0, 1, 1, -1}));
  EXPECT_EQ(file.graph.radii, (Radii{0.1, 0.2, 0.3, 0.4, 0.4}));
  EXPECT_EQ(file.graph.positions[3], (Vec3d{2, 2, 2}));
}

TEST(ObjLines, CloseWithASecondNodeAtTheBeginning) {
  const auto file = read_good_file(obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3 1", thick);
  EXPECT_EQ(file.graph.parents, (Parents{-1, 0, 1, 2}));
  EXPECT_EQ(file.graph.positions[3], file.graph.positions[0]);
  EXPECT_EQ(file.graph.radii, Radii(4, 0.5));
}

TEST(ObjLines, MayUseVerticesThatComeLater) {
  EXPECT_EQ(read_good_file(obj, "l 1 2\nv 0 0 0 1\nv 1 0 0 1\n").graph.parents, (Parents{-1, 0}));
}

TEST(ObjLines, SayWhatIsWrongAndWhere) {
  expect_file_error(obj, "", 0, 0, "no lines");
  expect_file_error(obj, "v 0 0 0\nf 1 1 1\n", 0, 0, "no lines");
  expect_file_error(obj, "v 0 zero 0\np 1\n", 1, 5, "`zero` is not a finite number");
  expect_file_error(obj, "v 0 0\np 1\n", 1, 6, "2 numbers");
  expect_file_error(obj, "v 0 0 0\nv nan 0 0\nl 1 2\n", 2, 3, "finite", thick);
  expect_file_error(obj, "v 0 0 0\nv 1 0 0\n\n l 1 3\n", 4, 6, "no vertex 3", thick);
  expect_file_error(obj, "v 0 0 0\nv 1 0 0\nl 1 \\\n 2 3 # far\n", 4, 4, "no vertex 3", thick);
  expect_file_error(obj, "v 0 0 0\nl 1 -2\n", 2, 5, "no vertex -2", thick);
  expect_file_error(obj, "v 0 0 0\nl 0 1\n", 2, 3, "`0` is not the number of a vertex", thick);
  expect_file_error(obj, "v 0 0 0\nl 1\n", 2, 1, "two vertices", thick);
  expect_file_error(obj, "v 0 0 0\nv 1 0 0\nl 1 2\n", 1, 3, "vertex 1 has no radius");
  expect_file_error(obj, "v 0 0 0 1 0.5 0.5\nv 1 0 0 1 1 1\nl 1 2\n", 1, 3, "no radius");  // a colour is no radius
  expect_file_error(obj, "v 0 0 0 -1\nv 1 0 0 1\nl 1 2\n", 1, 9, "negative");
  expect_file_error(obj, "v 0 0 0 1\nv 1e16 0 0 1\nl 1 2\n", 2, 3, "`1e16` lies beyond");
}

TEST(ObjLines, TellAllMistakesOfAFileInTheOrderOfItsLines) {
  EXPECT_EQ(places_of_mistakes(obj,
                               "v 0 0 0 -1\n"
                               "v nan 0 x 1\n"
                               "v 1 0 0\n"  // no radius
                               "v 0 1 0\n"  // nor here: told once
                               "l 1 2 -9 zero 7\n"
                               "l 3 4\n"
                               "l 1\n"),
            (std::vector<std::string>{"1:9", "2:3", "2:9", "3:3", "5:7", "5:10", "5:15", "7:1"}));
}

TEST(Csv, FindsItsColumnsAndSeparator) {
  for (const std::string_view text :
       {"x,y,z,radius\n1,2,3,4\n", "X;Z;name;Y;Radius\r\n1;3;a;2;4\r\n", "# c\n\nx\ty\tz\tradius\n1\t2\t3\t4",
        "x y z radius\n 1  2 3 4 \n", "\"x\",\"y\",\"z\",\"radius\"\n\"1\", 2 ,3,\"4\"\n",
        "x;y;z;radius\n1,0;2;3;4,0\n", "\xEF\xBB\xBFx,y,z,radius\r1,2,3,4\r"}) {
    const auto file = read_good_file(csv, text);
    ASSERT_EQ(file.graph.positions, (std::vector<Vec3d>{{1, 2, 3}})) << text;
    EXPECT_EQ(file.graph.radii, (Radii{4}));
    EXPECT_EQ(file.graph.parents, (Parents{-1}));
  }
}

TEST(Csv, TakesColumnsByNumberAndByName) {
  const SkeletonOptions counted{.scale = 2, .columns = {.x = 2, .y = 3, .z = 4, .radius = 1}};
  EXPECT_EQ(read_good_file(csv, "4,1,2,3\n", counted).graph.positions[0], (Vec3d{2, 4, 6}));
  EXPECT_EQ(read_good_file(csv, "r,a,b,c\n4,1,2,3\n", counted).graph.radii, (Radii{8}));
  const SkeletonOptions named{.columns = {.x = "posx", .y = "posy", .z = 3, .radius = "r"}};
  EXPECT_EQ(read_good_file(csv, "posx,posy,posz,r\n1,2,3,4\n", named).graph.positions[0], (Vec3d{1, 2, 3}));
}

TEST(Csv, JoinsStrandsAndParents) {
  EXPECT_EQ(read_good_file(csv, "strand,x,y,z\na,0,0,0\na,1,0,0\nb,0,0,1\na,2,0,0\nb,1,0,1\n", thick).graph.parents,
            (Parents{-1, 0, -1, 1, 2}));
  EXPECT_EQ(read_good_file(csv, "id,parent,x,y,z\n7,9,0,0,0\n9,,1,0,0\n5,7,0,0,1\n", thick).graph.parents,
            (Parents{1, -1, 0}));
  EXPECT_EQ(read_good_file(csv, "x,y,z,parent\n0,0,0,0\n1,0,0,1\n2,0,0,2\n", thick).graph.parents, (Parents{-1, 0, 1}));
  EXPECT_EQ(read_good_file(csv, "id,x,y,z,parent\n0,0,0,0,-1\n1,1,0,0,0\n", thick).graph.parents, (Parents{-1, 0}));
}

TEST(Csv, SaysWhatIsWrongAndWhere) {
  expect_file_error(csv, "", 0, 0, "empty");
  expect_file_error(csv, "x,y,z,radius\n", 0, 0, "no rows");
  expect_file_error(csv, "1,2,3\n", 1, 1, "names no column `x`", thick);
  expect_file_error(csv, "x,y,z\n1,2,3\n", 1, 1, "no column for the radius");
  expect_file_error(csv, "x,y,z\n1,2,3\n1,two,3\n", 3, 3, "`two` is not a finite number", thick);
  expect_file_error(csv, "x,y,z\n1,2\n", 2, 4, "2 fields", thick);
  expect_file_error(csv, "x,y,z\n1,\"2,3\n", 2, 3, "quote", thick);
  expect_file_error(csv, "x,y,z,id,parent\n1,2,3,1,9\n", 2, 9, "no node 9", thick);
  expect_file_error(csv, "x,y,z,id,parent\n1,2,3,1.5,0\n", 2, 7, "not a whole number", thick);
  expect_file_error(csv, "x,y,z,id,parent\n1,2,3,1,2\n1,2,3,2,1\n", 2, 9, "own ancestor", thick);
  expect_file_error(csv, "radius,x,y,z\n-0.5,1,2,3\n", 2, 1, "the radius -0.5 is negative");
  expect_file_error(csv, "radius,x,y,z\n1,1,2e15,3\n", 2, 5, "`2e15` lies beyond");
  expect_file_error(csv, "1,2,3\n", 1, 1, "no column 9", {.radius = 1.0, .columns = {.x = 9, .y = 2, .z = 3}});
  expect_file_error(csv, "a,y,z\n", 1, 1, "no column `b`", {.radius = 1.0, .columns = {.x = "b"}});
  expect_file_error(csv, "x,y,z\n1,5,0,0\n", 2, 7, "the row has 4 fields, the first has 3", thick);
  EXPECT_TRUE(read_skeleton(csv, "x,y,z\n1,5,0,,\n", thick, "t"));
  expect_file_error(csv, "x,y,z,strand\n1,5,0,a\n1,6,0,\n", 3, 7, "names no strand", thick);
  std::string many = "x,y,z\n";
  for (int i = 0; i < 1000; ++i) many += "?\n";
  EXPECT_EQ(read_skeleton(csv, many, thick, "t").why().size(), 20u);
}

TEST(Csv, TellsAllMistakesOfATableInTheOrderOfItsRows) {
  EXPECT_EQ(places_of_mistakes(csv,
                               "id,x,y,z,radius,parent\n"
                               "1,0,0,0,1,0\n"
                               "2,0,0,0,1,77\n"
                               "3,0,two,?,1,2\n"
                               "4,0,0,0,-1,3\n"  // its parent has mistakes, and is there
                               "5,0\n"
                               "5.5,0,0,0,1,5\n"
                               "1,0,0,0,1,1\n"),
            (std::vector<std::string>{"3:11", "4:5", "4:9", "5:9", "6:4", "7:1", "8:1"}));
}

TEST(Csv, DoesNotChooseBetweenColumnsOfOneName) {
  const std::string text = "x,y,z,radius,X\n1,2,3,4,50\n";
  EXPECT_EQ(places_of_mistakes(csv, text), std::vector<std::string>{"1:14"});
  SkeletonOptions by_number = thick;
  by_number.columns.x = ColumnName{5};
  EXPECT_TRUE(read_skeleton(csv, text, by_number, "t"));
  EXPECT_TRUE(read_skeleton(csv, "x,y,z,radius,size,size\n1,2,3,4,5,6\n", thick, "t"));
}

struct HairText {
  std::string bytes = "HAIR";
  bool is_big = false;
  void number(std::uint32_t value, std::size_t size = 4) {
    for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * (is_big ? size - 1 - i : i) & 0xFF);
  }
  void real(float value) { number(std::bit_cast<std::uint32_t>(value)); }
  void header(std::uint32_t strands, std::uint32_t points, std::uint32_t arrays, std::uint32_t segments,
              float thickness) {
    for (const std::uint32_t n : {strands, points, arrays, segments}) number(n);
    real(thickness);
    bytes.resize(128);
  }
};

// Two strands, of one and of two segments.
std::string two_strands(bool is_big, float bad = 0) {
  HairText text{.is_big = is_big};
  text.header(2, 5, 1 | 2 | 4, 0, 0);
  text.number(1, 2);
  text.number(2, 2);
  for (int i = 0; i < 15; ++i) text.real(i == 7 ? bad + 7 : static_cast<float>(i));
  for (int i = 0; i < 5; ++i) text.real(0.5f);
  return text.bytes;
}

TEST(CyHair, ReadsStrandsInBothByteOrders) {
  for (const bool is_big : {false, true}) {
    const auto file = read_good_file(hair, two_strands(is_big));
    EXPECT_EQ(file.graph.parents, (Parents{-1, 0, -1, 2, 3}));
    EXPECT_EQ(file.graph.positions[4], (Vec3d{12, 13, 14}));
    EXPECT_EQ(file.graph.radii, Radii(5, 0.25));  // half the thickness
  }
}

TEST(CyHair, TakesDefaultsFromTheHeader) {
  HairText text;
  text.header(1, 3, 2, 2, 0.5f);
  for (int i = 0; i < 9; ++i) text.real(static_cast<float>(i));
  EXPECT_EQ(read_good_file(hair, text.bytes).graph.radii, Radii(3, 0.25));
  EXPECT_EQ(read_good_file(hair, text.bytes, thick).graph.radii, Radii(3, 0.5));
}

TEST(CyHair, SaysWhatIsWrong) {
  const std::string good = two_strands(false);
  expect_file_error(hair, "", 0, 0, "not a cyHair file");
  expect_file_error(hair, "HAIRY", 0, 0, "5 bytes");
  expect_file_error(hair, std::string_view(good).substr(0, good.size() - 1), 0, 0, "need 212");
  expect_file_error(hair, two_strands(false, std::numeric_limits<float>::infinity()), 0, 0, "point 2 of strand 1");
  const auto changed = [&](std::size_t at, char to) {
    std::string text = good;
    text[at] = to;
    return text;
  };
  expect_file_error(hair, changed(128, 9), 0, 0, "at least 10 points");
  expect_file_error(hair, changed(128, 0), 0, 0, "4 points together, but the header says 5");
  expect_file_error(hair, changed(12, 1), 0, 0, "no array of points");
  expect_file_error(hair, changed(4, 0), 0, 0, "no strands");
  expect_file_error(hair, changed(12, 3), 0, 0, "no thickness");
  expect_file_error(hair, changed(14, 1), 0, 0, "unknown arrays");
}

}  // namespace
}  // namespace marrow
