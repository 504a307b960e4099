// Skeleton files of every format.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "field/base/result.h"
#include "renderer/scene/files/skeleton_options.h"

namespace marrow {

enum class SkeletonFormat { Swc, Obj, Csv, Xyz, Pdb, CyHair };

/// As the ending of a name says, in any case: .swc; .obj; .csv, .tsv; .xyz, .extxyz; .pdb, .ent; .hair.
std::optional<SkeletonFormat> skeleton_format_of(const std::string& name);

/// Dispatches to the reader of the format. Precondition: elements of the options exist.
Result<SkeletonFile> read_skeleton(SkeletonFormat, std::string_view bytes, const SkeletonOptions&,
                                   const std::string& name);

}  // namespace marrow
