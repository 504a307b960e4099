// From atoms to nodes.
#include "renderer/scene/files/molecule.h"

#include <algorithm>
#include <bitset>
#include <utility>

#include <fmt/core.h>

#include "renderer/scene/files/elements.h"
#include "renderer/scene/files/node_list.h"

namespace marrow {
namespace {

using Wanted = std::bitset<element_count>;

Wanted wanted_elements(const SkeletonOptions& options) {
  Wanted wanted;
  if (options.elements.empty()) wanted.set();
  for (const std::string& symbol : options.elements)
    if (const auto element = find_element(symbol)) wanted.set(*element);
  return wanted;
}

void add_atoms(const Molecule& molecule, const Wanted& wanted, const SkeletonOptions& options, FileProblems& problems,
               NodeList& list) {
  for (const Atom& atom : molecule.atoms) {
    const Element& element = elements()[atom.element];
    if (!wanted[atom.element]) continue;
    if (element.van_der_waals == 0 && !options.radius)
      return problems.complain_of_file(fmt::format("no van der Waals radius of {} is known", element.symbol),
                                       "give the skeleton a `radius`");
    list.add(atom.at, element.van_der_waals, -1);
    if (problems.is_full()) return;
  }
}

void add_stick(const Vec3d& from, const Vec3d& to, double radius, NodeList& list) {
  list.add_in_scene_units(from, radius, -1);
  list.add_in_scene_units(to, radius, list.next_index() - 1);
}

// Halves are drawn only where colours change: the field of two halves is that of the whole.
void add_bonds(const std::vector<Atom>& atoms, const std::vector<Bond>& bonds, const Wanted& wanted, double radius,
               NodeList& list) {
  for (const auto& [i, k] : bonds) {
    const Atom &a = atoms[static_cast<std::size_t>(i)], &b = atoms[static_cast<std::size_t>(k)];
    const Vec3d middle = a.at + (b.at - a.at) * 0.5;
    if (wanted[a.element] && wanted[b.element]) add_stick(a.at, b.at, radius, list);
    else if (wanted[a.element]) add_stick(a.at, middle, radius, list);
    else if (wanted[b.element]) add_stick(b.at, middle, radius, list);
  }
}

}  // namespace

SkeletonFile skeleton_of(Molecule molecule, const SkeletonOptions& options, FileProblems& problems) {
  NodeList list(options, problems);
  const Wanted wanted = wanted_elements(options);
  if (molecule.atoms.empty()) problems.complain_of_file("the file has no atoms");
  else add_atoms(molecule, wanted, options, problems, list);
  if (problems.none() && options.bonds) {
    std::vector<Bond>& bonds = molecule.bonds;
    const std::vector<Bond> near = bonds_by_distance(molecule.atoms, problems);
    bonds.insert(bonds.end(), near.begin(), near.end());
    std::sort(bonds.begin(), bonds.end());
    bonds.erase(std::unique(bonds.begin(), bonds.end()), bonds.end());
    add_bonds(molecule.atoms, bonds, wanted, *options.bonds, list);
  }
  if (problems.none() && list.size() == 0) problems.complain_of_file("the file has no atom of the chosen elements");
  return problems.none() ? std::move(list).finish() : SkeletonFile{};
}

}  // namespace marrow
