#include "field/trace/strand_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "field/math/elementary.h"
#include "field/math/vec3.h"

namespace marrow {
namespace {

constexpr std::size_t n = tensor_components;
using Matrix = std::array<std::array<double, n>, n>;

// Components of u^8, as kernels/strand_samples.h orders them.
std::array<double, n> eighth_power(const Vec3d& u) {
  std::array<double, n> t{};
  std::size_t at = 0;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j)
      t[at++] = integer_power(u.x, i) * integer_power(u.y, j) * integer_power(u.z, 8 - i - j);
  return t;
}

std::array<double, n> make_counts() {
  constexpr double factorial[] = {1, 1, 2, 6, 24, 120, 720, 5040, 40320};
  std::array<double, n> counts{};
  std::size_t at = 0;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j) counts[at++] = factorial[8] / (factorial[i] * factorial[j] * factorial[8 - i - j]);
  return counts;
}

// Gauss and Jordan, with the largest pivot of each column.
Matrix inverse_of(Matrix a) {
  Matrix inverse{};
  for (std::size_t i = 0; i < n; ++i) inverse[i][i] = 1;
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < n; ++r)
      if (std::fabs(a[r][c]) > std::fabs(a[pivot][c])) pivot = r;
    std::swap(a[pivot], a[c]);
    std::swap(inverse[pivot], inverse[c]);
    const double d = a[c][c];
    for (std::size_t k = 0; k < n; ++k) a[c][k] /= d, inverse[c][k] /= d;
    for (std::size_t r = 0; r < n; ++r) {
      if (r == c) continue;
      const double by = a[r][c];
      for (std::size_t k = 0; k < n; ++k) a[r][k] -= by * a[c][k], inverse[r][k] -= by * inverse[c][k];
    }
  }
  return inverse;
}

struct Axes {
  alignas(64) float lanes[3 * tensor_floats] = {};
  alignas(64) float weights[n][tensor_floats] = {};  // of each component, of all axes

  Axes() {
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
    Matrix powers{};  // column k: the tensor of axis k
    for (std::size_t k = 0; k < n; ++k) {
      const double at = static_cast<double>(k), z = (at + 0.36) / static_cast<double>(n), r = std::sqrt(1 - z * z);
      const double v[3] = {r * cos(turn * at), r * sin(turn * at), z};
      Vec3d u;
      for (std::size_t i = 0; i < 3; ++i) {
        lanes[i * tensor_floats + k] = static_cast<float>(v[i]);
        u[i] = static_cast<double>(lanes[i * tensor_floats + k]);
      }
      const auto power = eighth_power(u);
      for (std::size_t b = 0; b < n; ++b) powers[b][k] = power[b];
    }
    const Matrix inverse = inverse_of(powers);
    for (std::size_t b = 0; b < n; ++b)
      for (std::size_t k = 0; k < n; ++k) weights[b][k] = static_cast<float>(inverse[k][b]);
  }
};

const Axes& axes() {
  static const Axes made;
  return made;
}

}  // namespace

const float* strand_axes() { return axes().lanes; }

void weights_of_tensor(const float* tensor, float* weights) {
  const Axes& a = axes();
  std::fill_n(weights, tensor_floats, 0.0F);
  for (std::size_t b = 0; b < n; ++b)
    for (std::size_t k = 0; k < tensor_floats; ++k) weights[k] += a.weights[b][k] * tensor[b];
}

double contracted_with_itself(const float* tensor) {
  static const std::array<double, n> counts = make_counts();
  double sum = 0;
  for (std::size_t b = 0; b < n; ++b)
    sum += counts[b] * static_cast<double>(tensor[b]) * static_cast<double>(tensor[b]);
  return sum;
}

}  // namespace marrow
