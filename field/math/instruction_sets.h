// What this machine can do of what kernels are compiled for.
#pragma once

namespace marrow {

inline bool has_avx2() { return __builtin_cpu_supports("avx2"); }
/// All that kernels use of it.
inline bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
}

}  // namespace marrow
