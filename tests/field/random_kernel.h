// Kernels of all families.
#pragma once

#include "tests/field/random.h"

namespace marrow::test {

/// The families by turns, up to a degree.
inline Kernel random_kernel(Random& random, int i, int highest_degree = 9) {
  const int n = random.whole(3, highest_degree);
  if (i % 3 == 0) return {.degree = n};
  return i % 3 == 1 ? Kernel{KernelFamily::Cauchy, n, random.between(0.5, 2)}
                    : Kernel{KernelFamily::Compact, n, random.between(1.5, 3)};
}

}  // namespace marrow::test
