#include "field/math/moment_series.h"

#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr double factorial(int k) { return k <= 1 ? 1 : k * factorial(k - 1); }

constexpr double multinomial(const Monomial& m) {
  return factorial(m.degree()) / (factorial(m.a) * factorial(m.b) * factorial(m.c));
}

// The constants of the Gegenbauer polynomials: C_k^l(c) = sum_j (-1)^j (l)_(k-j) / (j! (k-2j)!) (2c)^(k-2j) with the
// rising factorial (l)_i; the term with tensor degree i = k - 2j has (l)_(i+j) 2^i (-1)^j / (j! i!).
double gegenbauer_constant(double l, int tensor_degree, int j) {
  double rising = 1;
  for (int i = 0; i < tensor_degree + j; ++i) rising *= l + i;
  return (j % 2 ? -1 : 1) * rising * integer_power(2, tensor_degree) / (factorial(j) * factorial(tensor_degree));
}

// visit(monomial) for those of one degree.
template <class Visit>
void for_each_of_degree(int degree, const Visit& visit) {
  for (int a = degree; a >= 0; --a)
    for (int b = degree - a; b >= 0; --b) visit(Monomial{a, b, degree - a - b});
}

}  // namespace

// (x.r)^k |x|^(2j) as monomials: |x|^(2j) is a sum of squares of coordinates with multinomials.
MomentSeries::MomentSeries(int exponent, int degree) : degree_(degree) {
  const double l = exponent / 2.0;
  for (int total = 0; total <= degree; ++total) {
    for (int j = 0; 2 * j <= total; ++j) {
      const int k = total - 2 * j;
      for_each_of_degree(k, [&](const Monomial& m) {
        const std::size_t moment = first(j) + monomial_index(m.a, m.b, m.c);
        for (int a = 0; a <= j; ++a)
          for (int b = 0; a + b <= j; ++b) {
            const Monomial squares{a, b, j - a - b};
            const std::size_t to = monomial_index(m.a + 2 * squares.a, m.b + 2 * squares.b, m.c + 2 * squares.c);
            terms_.push_back({static_cast<std::uint16_t>(moment), static_cast<std::uint16_t>(to),
                              gegenbauer_constant(l, k, j) * multinomial(m) * multinomial(squares)});
          }
      });
    }
    terms_up_to_.push_back(terms_.size());
  }
}

// |y|^2 is a sum of three squares.
void MomentSeries::complete(std::span<double> moments, int degree) const {
  for (int j = 1; 2 * j <= degree; ++j) {
    const auto before = moments.subspan(first(j - 1));
    double* here = &moments[first(j)];
    for (int total = 0; total <= degree - 2 * j; ++total)
      for_each_of_degree(total, [&](const Monomial& m) {
        *here++ = before[monomial_index(m.a + 2, m.b, m.c)] + before[monomial_index(m.a, m.b + 2, m.c)] +
                  before[monomial_index(m.a, m.b, m.c + 2)];
      });
  }
}

void MomentSeries::add_to(std::span<double> coefficients, std::span<const double> moments, int degree) const {
  for (std::size_t i = 0; i < terms_up_to_[static_cast<std::size_t>(degree)]; ++i)
    coefficients[terms_[i].monomial] += terms_[i].factor * moments[terms_[i].moment];
}

}  // namespace marrow
