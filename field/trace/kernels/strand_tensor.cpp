#include "field/trace/kernels/strand_tensor.h"

namespace marrow {

double contracted(const float* a, const float* b) {
  double sum = 0;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j, ++a, ++b)
      sum += static_cast<double>(times_in_eighth.of[i][j]) * static_cast<double>(*a) * static_cast<double>(*b);
  return sum;
}

}  // namespace marrow
