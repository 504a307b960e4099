#include "field/trace/shares/share_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "field/trace/sources/far_field.h"
#include "field/trace/sources/polynomial_bend.h"

namespace marrow {
namespace {

// Bernstein's coefficients of the powers of z = 2 x - 1, 0 <= x <= 1: those of z^a are
// sum_j (-1)^(a-j) 2^j binom(a, j) binom(k, j) / binom(degree, j).
using OfPowers = std::array<std::array<double, SharePatch::degree + 1>, SharePatch::degree + 1>;
OfPowers bernstein_of_powers() {
  constexpr std::size_t n = SharePatch::degree;
  const auto choose = [](std::size_t m, std::size_t k) {
    double found = 1;
    for (std::size_t i = 0; i < k; ++i) found = found * static_cast<double>(m - i) / static_cast<double>(i + 1);
    return found;
  };
  OfPowers made{};
  for (std::size_t a = 0; a <= n; ++a)
    for (std::size_t k = 0; k <= n; ++k)
      for (std::size_t j = 0; j <= std::min(a, k); ++j)
        made[a][k] +=
            ((a - j) % 2 != 0 ? -1 : 1) * std::ldexp(choose(a, j) * choose(k, j) / choose(n, j), static_cast<int>(j));
  return made;
}

// The least and the largest of the coefficients by Bernstein's polynomials of all terms above the first degree, which
// lie between them. Axis by axis, as a term is a product of powers.
std::pair<double, double> range_beside_line(const SharePatch& patch) {
  constexpr std::size_t n = SharePatch::degree + 1;
  static const OfPowers of_powers = bernstein_of_powers();
  double by_z[n][n][n] = {}, by_yz[n][n][n] = {}, all[n][n][n] = {};  // exponents of x and y; of x; none
  for (std::size_t m = 0; m < SharePatch::coefficients; ++m) {
    const Monomial& p = monomials[m];
    if (p.degree() < 2) continue;
    const auto& bernstein = of_powers[static_cast<std::size_t>(p.c)];
    for (std::size_t z = 0; z < n; ++z) by_z[p.a][p.b][z] += static_cast<double>(patch.coefficient[m]) * bernstein[z];
  }
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; a + b < n; ++b)
      for (std::size_t y = 0; y < n; ++y)
        for (std::size_t z = 0; z < n; ++z) by_yz[a][y][z] += of_powers[b][y] * by_z[a][b][z];
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t x = 0; x < n; ++x)
      for (std::size_t y = 0; y < n; ++y)
        for (std::size_t z = 0; z < n; ++z) all[x][y][z] += of_powers[a][x] * by_yz[a][y][z];
  const std::span every(&all[0][0][0], n * n * n);
  const auto [low, high] = std::ranges::minmax(every);
  return {std::min(0.0, low), std::max(0.0, high)};
}

}  // namespace

void set_line(const SharePatch& patch, SharePart& part) {
  constexpr double rounding = 1e-6;  // of a share of some 1 in float, a few times
  const auto [low, high] = range_beside_line(patch);
  double level = 0.5 * (low + high);
  for (std::size_t m = 0; m < SharePatch::coefficients; ++m) {
    const Monomial& p = monomials[m];
    if (p.degree() == 0) level += static_cast<double>(patch.coefficient[m]);
    if (p.degree() == 1) part.slope[p.a > 0 ? 0 : p.b > 0 ? 1 : 2] = patch.coefficient[m] * patch.inverse_half;
  }
  part.level = static_cast<float>(level);
  part.bent = static_cast<float>(0.5 * (high - low) + rounding);
}

float bend_of(const SharePatch& patch) {
  constexpr double rounding = 1e-6;  // of three operations in float
  const double bend = polynomial_bend(SharePatch::coefficients, [&](std::size_t m) { return patch.coefficient[m]; });
  return static_cast<float>(bend * (1 + rounding)) * patch.inverse_half * patch.inverse_half;
}

}  // namespace marrow
