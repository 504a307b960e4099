#include "field/trace/levels/level_polynomials.h"

#include <cmath>
#include <cstdint>

namespace marrow {
namespace {

constexpr std::size_t gathered_monomials = monomials_to_degree(highest_far_degree);

// The coefficient of x^(e-2j) in T_e(x): (-1)^j e/(2 (e-j)) binom(e-j, j) 2^(e-2j).
double chebyshev_coefficient(int e, int j) {
  if (e == 0) return 1;
  double c = std::ldexp(0.5 * e / (e - j), e - 2 * j);
  for (int i = 1; i <= j; ++i) c *= -static_cast<double>(e - j - i + 1) / i;
  return c;
}

// A monomial as a multiple of a product of Chebyshev polynomials and a rest.
struct Reduced {
  struct Term {
    std::uint16_t monomial;
    double factor;
  };
  double multiple = 1;
  std::vector<Term> rest;

  explicit Reduced(const Monomial& m) {
    for (const int e : {m.a, m.b, m.c}) multiple /= chebyshev_coefficient(e, 0);
    for (int i = 0; 2 * i <= m.a; ++i)
      for (int j = 0; 2 * j <= m.b; ++j)
        for (int k = 0; 2 * k <= m.c; ++k) {
          if (i + j + k == 0) continue;
          const double factor =
              chebyshev_coefficient(m.a, i) * chebyshev_coefficient(m.b, j) * chebyshev_coefficient(m.c, k);
          rest.push_back(
              {static_cast<std::uint16_t>(monomial_index(m.a - 2 * i, m.b - 2 * j, m.c - 2 * k)), -multiple * factor});
        }
  }
};

const Reduced& reduced(std::size_t monomial) {
  static const std::vector<Reduced> all(monomials.begin(), monomials.begin() + gathered_monomials);
  return all[monomial];
}

std::array<double, 4> coefficients(const FarField& far, std::size_t i) {
  const Monomial& m = monomials[i];
  return {far.f[i], far.potential[monomial_index(m.a + 1, m.b, m.c)] * (m.a + 1),
          far.potential[monomial_index(m.a, m.b + 1, m.c)] * (m.b + 1),
          far.potential[monomial_index(m.a, m.b, m.c + 1)] * (m.c + 1)};
}

// On the way from one degree to the next.
struct Shortened {
  std::array<std::array<double, 4>, gathered_monomials> c;
  double f_error = 0, gradient_error = 0;  // of what was left out

  explicit Shortened(const FarField& far) {
    for (std::size_t i = 0; i < gathered_monomials; ++i) c[i] = coefficients(far, i);
  }
  // Rests of the highest degrees first, as they may be left out in their turn.
  void shorten(int from, int to) {
    for (std::size_t i = monomials_to_degree(from); i-- > monomials_to_degree(to);) {
      const Reduced& r = reduced(i);
      f_error += r.multiple * std::fabs(c[i][0]);
      gradient_error += r.multiple * length({c[i][1], c[i][2], c[i][3]});
      for (const Reduced::Term& t : r.rest)
        for (std::size_t k = 0; k < 4; ++k) c[t.monomial][k] += t.factor * c[i][k];
    }
  }
  bool is_within(const Economy& allowed) const { return f_error <= allowed.f && gradient_error <= allowed.gradient; }
};

}  // namespace

LevelPolynomials economized(const FarField& far, const Economy& economy) {
  Shortened kept(far);
  kept.shorten(far.degree, economy.most);
  int degree = economy.most;
  for (auto lower = evaluated_degrees.rbegin(); lower != evaluated_degrees.rend(); ++lower) {
    if (*lower >= economy.most) continue;
    Shortened shorter = kept;
    shorter.shorten(degree, *lower);
    if (!shorter.is_within(economy)) break;
    kept = shorter;
    degree = *lower;
  }
  LevelPolynomials out{.degree = degree,
                       .coefficients = {},
                       .f_error = far.f_error + kept.f_error,
                       .gradient_error = far.gradient_error + kept.gradient_error};
  out.coefficients.assign(kept.c.begin(), kept.c.begin() + static_cast<std::ptrdiff_t>(monomials_to_degree(degree)));
  return out;
}

}  // namespace marrow
