// Molecules in XYZ and extended XYZ.
#pragma once

#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/files/skeleton_options.h"

namespace marrow {

/// The first frame: a count of atoms, a comment, then `symbol x y z` a line (or an atomic number for the symbol), where
/// further columns are left out. Of extended XYZ, `Properties=` in the comment is understood. Radii are van der Waals
/// radii (elements.h), bonds by distance (molecule.h). Errors: each wrong line, up to 20; a file with fewer atoms than
/// its count.
Result<SkeletonFile> read_xyz(std::string_view text, const SkeletonOptions&, const std::string& name);

}  // namespace marrow
