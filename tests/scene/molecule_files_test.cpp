// Molecules: XYZ and PDB, elements, bonds.
#include <algorithm>
#include <random>
#include <set>

#include "renderer/scene/files/elements.h"
#include "renderer/scene/files/molecule.h"
#include "tests/scene/skeleton_file_text.h"

namespace marrow {
namespace {

using Parents = std::vector<std::int32_t>;
constexpr auto xyz = SkeletonFormat::Xyz, pdb = SkeletonFormat::Pdb;

double van_der_waals(std::string_view symbol) { return elements()[*find_element(symbol)].van_der_waals; }

TEST(Elements, AreFoundByTheirSymbols) {
  std::set<std::string> symbols;
  for (std::size_t i = 0; i < element_count; ++i) {
    const Element& element = elements()[i];
    symbols.insert(element.symbol);
    EXPECT_EQ(find_element(element.symbol), i);
    EXPECT_TRUE(element.van_der_waals == 0 || element.van_der_waals > element.covalent) << element.symbol;
    EXPECT_LT(element.van_der_waals, 3.5) << element.symbol;
  }
  EXPECT_EQ(symbols.size(), element_count);
  EXPECT_EQ(find_element("FE2+"), 25u);
  EXPECT_EQ(find_element("d"), 0u);
  for (const char* none : {"", "Xx", "1", "Carbon", "?"}) EXPECT_FALSE(find_element(none)) << none;
}

// Of the papers that the table names.
TEST(Elements, HaveTheirPublishedRadii) {
  EXPECT_EQ(van_der_waals("H"), 1.10);
  EXPECT_EQ(van_der_waals("C"), 1.70);
  EXPECT_EQ(van_der_waals("Fe"), 2.44);
  EXPECT_EQ(van_der_waals("Ra"), 2.83);
  EXPECT_EQ(elements()[*find_element("C")].covalent, 0.76);
  EXPECT_EQ(elements()[*find_element("Cm")].covalent, 1.69);
}

TEST(Xyz, ReadsTheFirstFrame) {
  const auto file =
      read_good_file(xyz, "3\r\nwater\r\nO 0 0 0\r\nh 0.96 0 0 0.1\r\n1 -0.24 0.93 0\r\n3\n\nC 0 0 0\n", {.scale = 2});
  EXPECT_EQ(file.graph.parents, Parents(3, -1));
  EXPECT_EQ(file.graph.positions[1], (Vec3d{1.92, 0, 0}));
  EXPECT_EQ(file.graph.radii, (std::vector<double>{2 * 1.52, 2 * 1.10, 2 * 1.10}));
}

TEST(Xyz, UnderstandsExtendedColumns) {
  const auto file = read_good_file(
      xyz, "1\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=id:I:1:pos:R:3:species:S:1 x=1\n7 1 2 3 S extra\n");
  EXPECT_EQ(file.graph.positions[0], (Vec3d{1, 2, 3}));
  EXPECT_EQ(file.graph.radii[0], 1.80);
}

TEST(Xyz, SaysWhatIsWrongAndWhere) {
  expect_file_error(xyz, "", 0, 0, "empty");
  expect_file_error(xyz, "C 0 0 0\n", 1, 1, "not a number of atoms");
  expect_file_error(xyz, "-1\n\n", 1, 1, "not a number of atoms");
  expect_file_error(xyz, "1e99\n\n", 1, 1, "not a number of atoms");
  expect_file_error(xyz, "2\n\nC 0 0 0\n", 0, 0, "2 atoms, but the file has 1");
  expect_file_error(xyz, "1\n\nC 0 0 0\nC 9 0 0\n", 4, 1, "`C 9 0 0` follows the last atom");
  expect_file_error(xyz, "1\n\nQq 0 0 0\n", 3, 1, "`Qq` is no chemical element");
  expect_file_error(xyz, "1\n\nC 0 0\n", 3, 6, "3 columns");
  expect_file_error(xyz, "1\n\nC 0 1e16 0\n", 3, 5, "`1e16` lies beyond");
  EXPECT_EQ(places_of_mistakes(xyz, "4\n\nQq x 0 y\nC 0 0 0\nC 0 0\n"),
            (std::vector<std::string>{"0:0", "3:1", "3:4", "3:8", "5:6"}));
  expect_file_error(xyz, "1\n\nC 0 inf 0\n", 3, 5, "`inf` is not a finite number");
  expect_file_error(xyz, "1\n\nOg 0 0 0\n", 0, 0, "no van der Waals radius of Og");
  expect_file_error(xyz, "1\n\nC 0 0 0\n", 0, 0, "no atom of the chosen", {.elements = {"O"}});
}

// The distances of water and of two carbons that are 1.54 apart, or too far.
TEST(Bonds, JoinWhatIsNear) {
  const auto bonds = [](std::string_view text) {
    const auto file = read_good_file(xyz, text, {.bonds = 0.1});
    return static_cast<int>(
        std::count_if(file.graph.parents.begin(), file.graph.parents.end(), [](int p) { return p >= 0; }));
  };
  EXPECT_EQ(bonds("3\n\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n"), 2);
  EXPECT_EQ(bonds("2\n\nC 0 0 0\nC 0 0 1.54\n"), 1);
  EXPECT_EQ(bonds("2\n\nC 0 0 0\nC 0 0 1.93\n"), 0);
  EXPECT_EQ(bonds("2\n\nC 0 0 0\nC 0 0 0.1\n"), 0);
}

TEST(Bonds, OfChosenElementsAreHalves) {
  const auto file = read_good_file(xyz, "2\n\nC 0 0 0\nO 0 0 1.2\n", {.bonds = 0.1, .elements = {"O"}});
  EXPECT_EQ(file.graph.positions, (std::vector<Vec3d>{{0, 0, 1.2}, {0, 0, 1.2}, {0, 0, 0.6}}));
  EXPECT_EQ(file.graph.radii, (std::vector<double>{1.52, 0.1, 0.1}));
  EXPECT_EQ(file.graph.parents, (Parents{-1, -1, 1}));
}

TEST(Bonds, AgreeWithEveryPairTried) {
  const unsigned seed = 5;
  RecordProperty("seed", static_cast<int>(seed));
  std::mt19937 random(seed);
  const auto coordinate = [&] { return static_cast<double>(random() % 1600) * 0.01 - 8; };
  std::vector<Atom> atoms;
  const char* const symbols[] = {"H", "C", "O", "S", "Fe"};
  for (int i = 0; i < 400; ++i)
    atoms.push_back({{coordinate(), coordinate(), coordinate()}, *find_element(symbols[random() % 5])});
  std::vector<Bond> expected;
  for (std::int32_t i = 0; i < 400; ++i)
    for (std::int32_t k = i + 1; k < 400; ++k) {
      const Atom &a = atoms[static_cast<std::size_t>(i)], &b = atoms[static_cast<std::size_t>(k)];
      const double d = length(a.at - b.at);
      if (d > 0.4 && d <= elements()[a.element].covalent + elements()[b.element].covalent + 0.4)
        expected.push_back({i, k});
    }
  FileProblems problems({}, "t");
  EXPECT_EQ(bonds_by_distance(atoms, problems), expected) << "seed " << seed;
  EXPECT_GT(expected.size(), 50u);
}

TEST(Bonds, OfAHeapOfAtomsAreRefusedQuickly) {
  std::string text = "100000\n\n";
  for (int i = 0; i < 100000; ++i) text += "C 1 1 1\n";
  expect_file_error(xyz, text, 0, 0, "too dense", {.bonds = 0.1});
}

std::string atom(const char* record, int serial, const char* name, char location, int residue, double x,
                 const char* element) {
  char line[96];
  std::snprintf(line, sizeof line, "%-6s%5d %4s%cRES A%4d    %8.3f%8.3f%8.3f  1.00  0.00          %2s\n", record,
                serial, name, location, residue, x, 2.0, -3.0, element);
  return line;
}

TEST(Pdb, ReadsColumns) {
  const auto file = read_good_file(pdb, "HEADER  x\n" + atom("ATOM", 1, " CA ", ' ', 1, -100.125, " C") +
                                            atom("HETATM", 2, "CA  ", ' ', 2, 5, "CA") + "TER\nEND\n");
  EXPECT_EQ(file.graph.positions, (std::vector<Vec3d>{{-100.125, 2, -3}, {5, 2, -3}}));
  EXPECT_EQ(file.graph.radii, (std::vector<double>{1.70, 2.31}));
}

TEST(Pdb, TakesTheElementFromTheNameOfTheAtomWhereColumnsAreMissing) {
  const auto radius = [](const char* record, const char* name) {
    const auto file = read_good_file(pdb, atom(record, 1, name, ' ', 1, 0, "  "));
    return file.graph.radii.empty() ? 0.0 : file.graph.radii[0];
  };
  EXPECT_EQ(radius("ATOM", " CA "), van_der_waals("C"));
  EXPECT_EQ(radius("ATOM", "HG11"), van_der_waals("H"));
  EXPECT_EQ(radius("ATOM", "1HB "), van_der_waals("H"));
  EXPECT_EQ(radius("HETATM", "FE  "), van_der_waals("Fe"));
  EXPECT_EQ(radius("HETATM", " O  "), van_der_waals("O"));
}

TEST(Pdb, TakesOneModelAndOneLocation) {
  const std::string first = atom("ATOM", 1, " N  ", 'B', 1, 0, " N") + atom("ATOM", 2, " N  ", 'A', 1, 9, " N") +
                            atom("ATOM", 3, " O  ", ' ', 1, 1, " O") + atom("ATOM", 4, " C  ", 'A', 2, 2, " C");
  const auto file = read_good_file(pdb, "MODEL 1\n" + first + "ENDMDL\nMODEL 2\n" + first + "ENDMDL\n");
  EXPECT_EQ(file.graph.positions.size(), 3u);
  EXPECT_EQ(file.graph.positions[2].x, 2);
}

TEST(Pdb, JoinsWhatConectNames) {
  const auto file =
      read_good_file(pdb,
                     atom("ATOM", 7, " C  ", ' ', 1, 0, " C") + atom("ATOM", 9, " C  ", ' ', 1, 50, " C") +
                         "CONECT    7    9\nCONECT    9    7   99\n",
                     {.bonds = 0.25});
  EXPECT_EQ(file.graph.parents, (Parents{-1, -1, -1, 2}));
  EXPECT_EQ(file.graph.radii[3], 0.25);
}

TEST(Pdb, SaysWhatIsWrongAndWhere) {
  expect_file_error(pdb, "", 0, 0, "no atoms");
  expect_file_error(pdb, "ATOM      1  CA  RES A   1       0.000   0.000\n", 1, 47, "ends before");
  std::string text = atom("ATOM", 1, " CA ", ' ', 1, 0, " C");
  text.replace(38, 8, "   x.000");
  expect_file_error(pdb, "REMARK\n" + text, 2, 42, "`x.000` is not a finite number");
  expect_file_error(pdb, atom("ATOM", 1, " ?? ", ' ', 1, 0, "  "), 1, 13, "no known element");
}

}  // namespace
}  // namespace marrow
