// A skeleton as branches between its junctions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/description/field_node.h"

namespace marrow {

/// Paths of nodes, one after another in one list.
struct Branches {
  struct Path {
    std::size_t begin, end;  ///< in `nodes`
    bool is_closed;          ///< the last node is joined to the first, which is not repeated
  };
  std::vector<std::int32_t> nodes;
  std::vector<Path> paths;
  std::vector<std::int32_t> balls;  ///< roots without children

  std::span<const std::int32_t> of(const Path& path) const {
    return std::span(nodes).subspan(path.begin, path.end - path.begin);
  }
};

/// Every segment of the skeleton belongs to one path. Nodes at the same place are one joint. A path ends where a joint
/// has one, three or more segments, or is in `sticking`; paths without such an end are closed. Segments without length
/// are left out. The order depends only on that of the nodes.
Branches branches_of(const SkeletonGraph&, std::span<const std::int32_t> sticking = {});

}  // namespace marrow
