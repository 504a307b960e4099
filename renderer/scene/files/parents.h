// Parents by their ids become parents by their places.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/scene/files/text_scan.h"

namespace marrow {

struct NamedNode {
  static constexpr std::int64_t no_parent = -1;
  std::int64_t id;
  std::int64_t parent;   ///< an id; negative (and not its own): a root
  const char* id_place;  ///< of its text, for messages
  const char* parent_place;
};

/// The index of each node's parent, or -1. Ids may stand in any order, children before parents. Reports ids that are
/// given twice (the first counts), parents that are missing, and circles; the result is then of no use.
std::vector<std::int32_t> parent_indices(const std::vector<NamedNode>&, FileProblems&);

}  // namespace marrow
