#include "field/trace/strand_tensor.h"

#include <array>
#include <cstddef>

#include "field/trace/block_view.h"

namespace marrow {
namespace {

// How often each component is among the 3^8 products of the eighth power.
std::array<double, tensor_components> make_counts() {
  constexpr double factorial[] = {1, 1, 2, 6, 24, 120, 720, 5040, 40320};
  std::array<double, tensor_components> counts{};
  std::size_t at = 0;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j) counts[at++] = factorial[8] / (factorial[i] * factorial[j] * factorial[8 - i - j]);
  return counts;
}

}  // namespace

double contracted_with_itself(const float* tensor) {
  static const std::array<double, tensor_components> counts = make_counts();
  double sum = 0;
  for (std::size_t b = 0; b < counts.size(); ++b)
    sum += counts[b] * static_cast<double>(tensor[b]) * static_cast<double>(tensor[b]);
  return sum;
}

}  // namespace marrow
