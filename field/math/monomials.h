// Polynomials in three variables as coefficients of monomials x^a y^b z^c, those of a lower degree first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace marrow {

/// Monomials of degree <= k in three variables: binom(k + 3, 3).
constexpr std::size_t monomials_to_degree(int k) { return static_cast<std::size_t>((k + 1) * (k + 2) * (k + 3) / 6); }

/// Exponents of x^a y^b z^c.
struct Monomial {
  int a, b, c;
  constexpr int degree() const { return a + b + c; }
};

/// All to a degree, sorted by degree.
template <int Degree>
constexpr std::array<Monomial, monomials_to_degree(Degree)> make_monomials() {
  std::array<Monomial, monomials_to_degree(Degree)> m{};
  std::size_t i = 0;
  for (int d = 0; d <= Degree; ++d)
    for (int a = d; a >= 0; --a)
      for (int b = d - a; b >= 0; --b) m[i++] = {a, b, d - a - b};
  return m;
}

/// The place of x^a y^b z^c among them.
constexpr std::size_t monomial_index(int a, int b, int c) {
  const int d = a + b + c, rest = d - a;
  return monomials_to_degree(d - 1) + static_cast<std::size_t>(rest * (rest + 1) / 2 + rest - b);
}

/// Monomials that differ only in the exponent of one axis, in its order: a polynomial of that axis alone.
template <int Degree>
struct AxisLines {
  using Line = std::array<std::uint16_t, Degree + 1>;
  /// Pairs of exponents of the other two axes, by their sum, so that those of a smaller degree come first.
  static constexpr std::size_t count = (Degree + 1) * (Degree + 2) / 2;
  std::array<std::array<Line, count>, 3> of{};

  constexpr AxisLines() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::size_t n = 0;
      for (int sum = 0; sum <= Degree; ++sum)
        for (int p = 0, q = sum; p <= sum; ++p, --q, ++n)
          for (int e = 0; e + sum <= Degree; ++e)
            of[axis][n][static_cast<std::size_t>(e)] =
                static_cast<std::uint16_t>(axis == 0   ? monomial_index(e, p, q)
                                           : axis == 1 ? monomial_index(p, e, q)
                                                       : monomial_index(p, q, e));
    }
  }
};

/// p(x) of a degree up to Highest with x_axis = shift + scale x'_axis, as a polynomial in x': repeated synthetic
/// division along each line.
template <int Highest>
void move_axis(std::array<double, monomials_to_degree(Highest)>& p, int degree, std::size_t axis, double shift,
               double scale) {
  static constexpr AxisLines<Highest> lines;
  const auto* line = lines.of[axis].data();
  for (int sum = 0; sum <= degree; ++sum)
    for (int k = 0; k <= sum; ++k, ++line) {
      const int size = degree - sum + 1;
      std::array<double, Highest + 1> c;
      for (int i = 0; i < size; ++i) c[static_cast<std::size_t>(i)] = p[(*line)[static_cast<std::size_t>(i)]];
      for (int begin = 0; begin + 1 < size; ++begin)
        for (int i = size - 2; i >= begin; --i)
          c[static_cast<std::size_t>(i)] += shift * c[static_cast<std::size_t>(i) + 1];
      double power = 1;
      for (int i = 0; i < size; ++i, power *= scale)
        p[(*line)[static_cast<std::size_t>(i)]] = c[static_cast<std::size_t>(i)] * power;
    }
}

}  // namespace marrow
