#include "field/tree/nodes/restricted_blend.h"

#include <cmath>

namespace marrow {

std::string RestrictedBlend::problem(std::size_t children) const {
  for (const auto& pair : neighbours) {
    if (pair.size() != 2) return "neighbours must be pairs of children";
    for (const double child : pair) {
      if (child != std::floor(child) || !(child < static_cast<double>(children)))
        return "neighbours must be whole numbers below the number of children";
    }
    if (pair[0] == pair[1]) return "a child cannot be its own neighbour";
  }
  return {};
}

std::vector<std::vector<std::size_t>> RestrictedBlend::links(std::size_t children) const {
  std::vector<std::vector<std::size_t>> linked(children);
  for (const auto& pair : neighbours) {
    const auto a = static_cast<std::size_t>(pair[0]), b = static_cast<std::size_t>(pair[1]);
    linked[a].push_back(b);
    linked[b].push_back(a);
  }
  return linked;
}

}  // namespace marrow
