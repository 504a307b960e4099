// Molecules: balls for atoms and sticks for bonds.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "field/math/vec3.h"
#include "renderer/scene/files/skeleton_options.h"
#include "renderer/scene/files/text_scan.h"

namespace marrow {

struct Atom {
  Vec3d at;              ///< in angstrom, as files have it
  std::uint8_t element;  ///< index into elements()
};
using Bond = std::array<std::int32_t, 2>;  ///< indices of atoms, the smaller first

struct Molecule {
  std::vector<Atom> atoms;
  std::vector<Bond> bonds;  ///< those that the file names
};

/// Pairs of atoms whose distance is at most the sum of their covalent radii and 0.4 angstrom, and more than 0.4 (nearer
/// atoms are one place twice), in ascending order. [rule and tolerance: Meng and Lewis, J. Comput. Chem. 12 (1991) 891]
/// Reports atoms so dense that no molecule has them.
std::vector<Bond> bonds_by_distance(const std::vector<Atom>&, FileProblems&);

/// Atoms of the wanted elements as balls with their van der Waals radius, and, if bonds are wanted, every bond of the
/// file or by distance as a stick. Where elements are chosen, an atom has its half of each bond. Problems are reported.
SkeletonFile skeleton_of(Molecule, const SkeletonOptions&, FileProblems&);

}  // namespace marrow
