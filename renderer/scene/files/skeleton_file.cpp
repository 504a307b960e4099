// The formats by their endings and readers.
#include "renderer/scene/files/skeleton_file.h"

#include <algorithm>
#include <array>
#include <utility>

#include "renderer/scene/files/ascii.h"
#include "renderer/scene/files/csv.h"
#include "renderer/scene/files/cyhair.h"
#include "renderer/scene/files/obj_lines.h"
#include "renderer/scene/files/pdb.h"
#include "renderer/scene/files/swc.h"
#include "renderer/scene/files/xyz.h"

namespace marrow {
namespace {

constexpr std::pair<std::string_view, SkeletonFormat> endings[] = {
    {".swc", SkeletonFormat::Swc}, {".obj", SkeletonFormat::Obj}, {".csv", SkeletonFormat::Csv},
    {".tsv", SkeletonFormat::Csv}, {".xyz", SkeletonFormat::Xyz}, {".extxyz", SkeletonFormat::Xyz},
    {".pdb", SkeletonFormat::Pdb}, {".ent", SkeletonFormat::Pdb}, {".hair", SkeletonFormat::CyHair},
};

}  // namespace

std::optional<SkeletonFormat> skeleton_format_of(const std::string& name) {
  const std::string ending = ending_of(name);
  const auto* found =
      std::find_if(std::begin(endings), std::end(endings), [&](const auto& e) { return e.first == ending; });
  return found == std::end(endings) ? std::nullopt : std::optional(found->second);
}

Result<SkeletonFile> read_skeleton(SkeletonFormat format, std::string_view bytes, const SkeletonOptions& options,
                                   const std::string& name) {
  using Reader = Result<SkeletonFile> (*)(std::string_view, const SkeletonOptions&, const std::string&);
  constexpr std::array<Reader, 6> readers{read_swc, read_obj_lines, read_csv, read_xyz, read_pdb, read_cyhair};
  return readers[static_cast<std::size_t>(format)](bytes, options, name);
}

}  // namespace marrow
