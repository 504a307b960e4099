#include "field/trace/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "field/math/elementary.h"
#include "field/trace/far_field.h"

namespace marrow {
namespace {

using Four = float __attribute__((vector_size(16)));
using Cube = std::array<Four, lattice_nodes>;

// Values at the five nodes of a line to the coefficients of T0 .. T4.
void to_chebyshev(Four* v, std::size_t stride) {
  const Four v0 = v[0], v1 = v[stride], v2 = v[2 * stride], v3 = v[3 * stride], v4 = v[4 * stride];
  const Four even1 = v0 + v4, even2 = v1 + v3, odd1 = v4 - v0, odd2 = v3 - v1;
  const Four c1 = (4.0F / 3) * odd2 - (1.0F / 6) * odd1, c3 = (2.0F / 3) * odd1 - (4.0F / 3) * odd2;
  const Four c2 = (8.0F / 3) * even2 - (1.0F / 6) * even1 - 5 * v2, c4 = (2.0F / 3) * (even1 - 4 * even2) + 4 * v2;
  v[0] = v2 + 0.5F * c2 + 0.375F * c4;
  v[stride] = c1 + 0.75F * c3;
  v[2 * stride] = 0.5F * (c2 + c4);
  v[3 * stride] = 0.25F * c3;
  v[4 * stride] = 0.125F * c4;
}

// The first `count` coefficients of a Chebyshev series to those of powers.
void to_powers(Four* v, std::size_t stride, int count) {
  Four* const v1 = v + stride;
  Four* const v2 = v1 + stride;
  if (count > 4) {
    Four& v4 = v2[2 * stride];
    v[0] += v4;
    v2[0] -= 8 * v4;
    v4 *= 8;
  }
  if (count > 3) {
    Four& v3 = v2[stride];
    v1[0] -= 3 * v3;
    v3 *= 4;
  }
  if (count > 2) {
    v[0] -= v2[0];
    v2[0] *= 2;
  }
}

constexpr std::size_t strides[3] = {1, lattice_side, lattice_side* lattice_side};

}  // namespace

void lattice_polynomial(const float* values, float* polynomial) {
  Cube c;
  std::memcpy(c.data(), values, sizeof c);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t b = strides[(axis + 1) % 3], d = strides[(axis + 2) % 3];
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = 0; j < 5; ++j) to_chebyshev(&c[i * b + j * d], strides[axis]);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t b = strides[(axis + 1) % 3], d = strides[(axis + 2) % 3];
    for (int i = 0; i < 5; ++i)
      for (int j = 0; i + j < 5; ++j)
        to_powers(&c[static_cast<std::size_t>(i) * b + static_cast<std::size_t>(j) * d], strides[axis], 5 - i - j);
  }
  for (std::size_t i = 0; i < monomials_to_degree(4); ++i) {
    const Monomial& m = monomials[i];
    std::memcpy(polynomial + 4 * i, &c[static_cast<std::size_t>(m.a + 5 * m.b + 25 * m.c)], sizeof(Four));
  }
}

namespace {

struct Source {
  std::array<float, 3> at;
  int exponent;

  Four field(float x, float y, float z) const {
    const float dx = x - at[0], dy = y - at[1], dz = z - at[2], inverse = 1 / (dx * dx + dy * dy + dz * dz);
    const float f = static_cast<float>(integer_power(std::sqrt(inverse), exponent));
    const float g = -static_cast<float>(exponent) * f * inverse;
    return Four{f, g * dx, g * dy, g * dz};
  }
};

Four polynomial_at(const float* c, float x, float y, float z) {
  Four sum{};
  std::array<std::array<float, 5>, 3> powers;
  for (std::size_t k = 0; k < 3; ++k) {
    powers[k][0] = 1;
    for (std::size_t i = 1; i < 5; ++i) powers[k][i] = powers[k][i - 1] * (k == 0 ? x : k == 1 ? y : z);
  }
  for (std::size_t i = 0; i < monomials_to_degree(4); ++i) {
    const Monomial& m = monomials[i];
    Four v;
    std::memcpy(&v, c + 4 * i, sizeof v);
    sum += v * (powers[0][static_cast<std::size_t>(m.a)] * powers[1][static_cast<std::size_t>(m.b)] *
                powers[2][static_cast<std::size_t>(m.c)]);
  }
  return sum;
}

constexpr std::array<float, 5> node_places = {-1, -0.5F, 0, 0.5F, 1};
constexpr std::array<float, 7> probe_places = {-1.001F, -0.75F, -0.25F, 0.25F, 0.7F, 0.85F, 1.001F};

LatticeError largest_error(const Source& source) {
  Cube values;
  std::size_t node = 0;
  for (const float z : node_places)
    for (const float y : node_places)
      for (const float x : node_places) values[node++] = source.field(x, y, z);
  std::array<float, 4 * monomials_to_degree(4)> polynomial;
  lattice_polynomial(reinterpret_cast<const float*>(values.data()), polynomial.data());
  LatticeError worst{0, 0};
  for (const float z : probe_places)
    for (const float y : probe_places)
      for (const float x : probe_places) {
        const Four off = polynomial_at(polynomial.data(), x, y, z) - source.field(x, y, z);
        worst.field = std::max(worst.field, std::fabs(off[0]));
        worst.gradient = std::max(worst.gradient, std::sqrt(off[1] * off[1] + off[2] * off[2] + off[3] * off[3]));
      }
  return worst;
}

}  // namespace

LatticeError lattice_error(int exponent) {
  constexpr std::array<std::array<float, 3>, 7> directions = {
      {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0, 1, 2}, {1, 1, 2}, {1, 2, 2}, {1, 2, 3}}};
  constexpr float margin = 1.25F, step = 1.125F;
  LatticeError worst{0, 0};
  float distance = std::sqrt(LatticeError::nearest);
  for (int i = 0; i < 19; ++i, distance *= step) {
    const float root = std::sqrt(distance * distance - LatticeError::offset);
    const auto fall = static_cast<float>(integer_power(root, exponent + 5)) * margin;
    for (const auto& d : directions) {
      const float scale = distance / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      const LatticeError e = largest_error({{d[0] * scale, d[1] * scale, d[2] * scale}, exponent});
      worst = {std::max(worst.field, fall * e.field), std::max(worst.gradient, fall * root * e.gradient)};
    }
  }
  return worst;
}

}  // namespace marrow
