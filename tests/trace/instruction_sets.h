// The instruction sets that this machine can run.
#pragma once

#include <string>
#include <vector>

#include "field/trace/kernels/block_kernels.h"

namespace marrow::test {

inline std::vector<std::string> sets_here() {
  std::vector<std::string> names;
  for (const char* name : {"sse4", "avx2", "avx512"})
    if (block_kernels(name) != nullptr) names.emplace_back(name);
  return names;
}

}  // namespace marrow::test
