// Which atoms are near enough for a bond: atoms sorted into cells as wide as the longest bond.
#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/scene/files/elements.h"
#include "renderer/scene/files/molecule.h"

namespace marrow {
namespace {

constexpr double tolerance = 0.4;  // angstrom [Meng and Lewis 1991]

struct Cell {
  std::int64_t x, y, z;
  friend auto operator<=>(const Cell&, const Cell&) = default;
};
struct Member {
  Cell cell;
  std::int32_t atom;
  friend auto operator<=>(const Member&, const Member&) = default;
};

double longest_bond(const std::vector<Atom>& atoms) {
  double largest = 0;
  for (const Atom& atom : atoms) largest = std::max(largest, elements()[atom.element].covalent);
  return 2 * largest + tolerance;
}

std::vector<Member> sorted_into_cells(const std::vector<Atom>& atoms, double width) {
  std::vector<Member> members;
  members.reserve(atoms.size());
  // Positions are at most 1e15 scene units at any scale; what is farther is far from everything.
  const auto index = [width](double x) {
    return static_cast<std::int64_t>(std::clamp(std::floor(x / width), -4e18, 4e18));
  };
  for (std::size_t i = 0; i < atoms.size(); ++i)
    members.push_back(
        {{index(atoms[i].at.x), index(atoms[i].at.y), index(atoms[i].at.z)}, static_cast<std::int32_t>(i)});
  std::sort(members.begin(), members.end());
  return members;
}

// A cell is at most 5.6 angstrom wide, and the densest solid, diamond, has 0.18 atoms in a cubic angstrom: 31.
bool are_too_dense(const std::vector<Member>& members) {
  constexpr std::size_t most = 300;
  for (std::size_t i = most; i < members.size(); ++i)
    if (members[i].cell == members[i - most].cell) return true;
  return false;
}

bool are_bonded(const Atom& a, const Atom& b) {
  const double ra = elements()[a.element].covalent, rb = elements()[b.element].covalent;
  const double distance = length(b.at - a.at);
  return ra > 0 && rb > 0 && distance > tolerance && distance <= ra + rb + tolerance;
}

}  // namespace

std::vector<Bond> bonds_by_distance(const std::vector<Atom>& atoms, FileProblems& problems) {
  const std::vector<Member> members = sorted_into_cells(atoms, longest_bond(atoms));
  std::vector<Bond> bonds;
  if (are_too_dense(members)) {
    problems.complain_of_file("the atoms are too dense to tell their bonds", "positions are in angstrom");
    return bonds;
  }
  // Neighbours stand in nine rows of three cells. Going through the cells in order, the begin of each row only
  // advances.
  std::array<std::size_t, 9> begin_of_row{};
  for (const Member& one : members)
    for (std::size_t row = 0; row < begin_of_row.size(); ++row) {
      const auto dx = static_cast<std::int64_t>(row / 3) - 1, dy = static_cast<std::int64_t>(row % 3) - 1;
      const Cell first{one.cell.x + dx, one.cell.y + dy, one.cell.z - 1}, last{first.x, first.y, one.cell.z + 1};
      std::size_t& begin = begin_of_row[row];
      while (begin < members.size() && members[begin].cell < first) ++begin;
      for (std::size_t i = begin; i < members.size() && members[i].cell <= last; ++i)
        if (const std::int32_t other = members[i].atom;
            other > one.atom &&
            are_bonded(atoms[static_cast<std::size_t>(one.atom)], atoms[static_cast<std::size_t>(other)]))
          bonds.push_back({one.atom, other});
    }
  std::sort(bonds.begin(), bonds.end());
  return bonds;
}

}  // namespace marrow
