// How much each material contributes to a field at a point.
#pragma once

#include <algorithm>
#include <vector>

#include "field/base/id.h"

namespace marrow {

/// Shares that sum to 1, one for each material; invalid: the object's own. Empty where the field is 0.
struct MaterialWeight {
  MaterialId material;
  double weight = 0;
};
using MaterialWeights = std::vector<MaterialWeight>;

inline void add_weight(MaterialWeights& all, MaterialId material, double weight) {
  const auto known = std::find_if(all.begin(), all.end(), [&](const auto& w) { return w.material == material; });
  if (known != all.end()) known->weight += weight;
  else all.push_back({material, weight});
}
/// The first of the largest; invalid if there is none.
inline MaterialId strongest(const MaterialWeights& all) {
  const auto most =
      std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.weight < b.weight; });
  return most == all.end() ? MaterialId{} : most->material;
}

}  // namespace marrow
