// Molecules in the format of the Protein Data Bank.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/files/skeleton_options.h"

namespace marrow {

/// ATOM and HETATM of the first model, by their fixed columns; of alternate locations the one that a residue names
/// first. The element is that of columns 77-78 or, in files without, of the name of the atom. Radii are van der Waals
/// radii (elements.h); bonds are those of CONECT and those by distance (molecule.h). Errors: each line that is too
/// short or wrong, up to 20; no atoms.
/// [format: wwPDB, "Protein Data Bank Contents Guide", version 3.3, sections 9 and 10]
Result<SkeletonFile> read_pdb(std::string_view text, const SkeletonOptions&, const std::string& name);

}  // namespace marrow
