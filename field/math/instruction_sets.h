// What this machine can do of what kernels are compiled for.
#pragma once

#include <string_view>
#include <vector>

namespace marrow {

inline bool has_avx2() { return __builtin_cpu_supports("avx2"); }
/// All that kernels use of it.
inline bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
}

/// By the names that users give them, the narrowest first.
inline std::vector<std::string_view> instruction_sets() {
  std::vector<std::string_view> sets{"sse4"};
  if (has_avx2()) sets.push_back("avx2");
  if (has_avx512()) sets.push_back("avx512");
  return sets;
}

}  // namespace marrow
