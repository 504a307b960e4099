#include "field/trace/kernels/strand_tensor.h"

namespace marrow {

double contracted_with_itself(const float* tensor) {
  double sum = 0;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j, ++tensor)
      sum +=
          static_cast<double>(times_in_eighth.of[i][j]) * static_cast<double>(*tensor) * static_cast<double>(*tensor);
  return sum;
}

}  // namespace marrow
