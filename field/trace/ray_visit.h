// What a ray takes, cell by cell.
#pragma once

#include <cstdint>

namespace marrow {

/// A cell where a ray was searched for a root. A function of the ray and the cell, whatever parts of space are asked.
struct RayVisit {
  double begin = 0;               ///< t at which the ray first comes to where surface can be in it
  std::uint32_t evaluations = 0;  ///< of the field; those that tell on which side the ray begins are not counted
};

}  // namespace marrow
