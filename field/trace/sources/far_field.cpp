#include "field/trace/sources/far_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr int highest_degree = highest_far_degree + 1;

constexpr std::size_t first_of_degree(int d) { return static_cast<std::size_t>(d * (d + 1) * (d + 2) / 6); }

// For all k + 2j <= degree.
constexpr std::size_t moments_to_degree(int degree) {
  return degree < 0 ? 0 : monomials_to_degree(degree) + moments_to_degree(degree - 2);
}

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

// Monomials that differ only in the exponent of one axis, in its order: a polynomial of that axis alone.
struct Line {
  std::array<std::uint8_t, highest_degree + 1> at{};
};
// Pairs of exponents of the other two axes, by their sum, so that those of a smaller degree come first.
constexpr std::size_t line_count = (highest_degree + 1) * (highest_degree + 2) / 2;

constexpr std::array<std::array<Line, line_count>, 3> make_lines() {
  std::array<std::array<Line, line_count>, 3> lines{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::size_t n = 0;
    for (int sum = 0; sum <= highest_degree; ++sum)
      for (int p = 0, q = sum; p <= sum; ++p, --q, ++n)
        for (int e = 0; e + sum <= highest_degree; ++e)
          lines[axis][n].at[static_cast<std::size_t>(e)] =
              static_cast<std::uint8_t>(axis == 0   ? monomial_index(e, p, q)
                                        : axis == 1 ? monomial_index(p, e, q)
                                                    : monomial_index(p, q, e));
  }
  return lines;
}

constexpr auto axis_lines = make_lines();

// p(x) with x_axis = shift + x'_axis / 2, as a polynomial in x': repeated synthetic division along each line.
void shift_axis(Polynomial& p, int degree, std::size_t axis, double shift) {
  const auto* line = axis_lines[axis].data();
  for (int sum = 0; sum <= degree; ++sum)
    for (int k = 0; k <= sum; ++k, ++line) {
      const int size = degree - sum + 1;
      std::array<double, highest_degree + 1> c;
      for (int i = 0; i < size; ++i) c[static_cast<std::size_t>(i)] = p[line->at[static_cast<std::size_t>(i)]];
      for (int begin = 0; begin + 1 < size; ++begin)
        for (int i = size - 2; i >= begin; --i)
          c[static_cast<std::size_t>(i)] += shift * c[static_cast<std::size_t>(i) + 1];
      double scale = 1;
      for (int i = 0; i < size; ++i, scale *= 0.5)
        p[line->at[static_cast<std::size_t>(i)]] = c[static_cast<std::size_t>(i)] * scale;
    }
}

}  // namespace

// (x.r)^k |x|^(2j) as monomials: |x|^(2j) is a sum of squares of coordinates with multinomials.
MomentTable::MomentTable(int exponent, int far_degree) : far_degree_(far_degree) {
  const double l = exponent / 2.0;
  for (int degree = 0; degree <= far_degree + 1; ++degree) {
    std::size_t first_moment = 0;
    for (int j = 0; 2 * j <= degree; ++j) {
      const int k = degree - 2 * j;
      for (std::size_t i = first_of_degree(k); i < monomials_to_degree(k); ++i)
        for (int a = 0; a <= j; ++a)
          for (int b = 0; a + b <= j; ++b) {
            const Monomial m = monomials[i], squares{a, b, j - a - b};
            const std::size_t to = monomial_index(m.a + 2 * squares.a, m.b + 2 * squares.b, m.c + 2 * squares.c);
            terms_.push_back({static_cast<std::uint16_t>(first_moment + i), static_cast<std::uint16_t>(to),
                              gegenbauer_constant(l, k, j) * multinomial(m) * multinomial(squares)});
          }
      first_moment += monomials_to_degree(far_degree + 1 - 2 * j);
    }
    if (degree == far_degree) field_terms_ = terms_.size();
  }
}

// Where monomials times x^2, y^2 and z^2 are.
constexpr auto times_squares = [] {
  std::array<std::array<std::uint8_t, 3>, monomials_to_degree(highest_degree - 2)> at{};
  const auto index = [](int a, int b, int c) { return static_cast<std::uint8_t>(monomial_index(a, b, c)); };
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto [a, b, c] = monomials[i];
    at[i] = {index(a + 2, b, c), index(a, b + 2, c), index(a, b, c + 2)};
  }
  return at;
}();

// One j after the other.
struct MomentTable::Moments {
  std::array<double, moments_to_degree(highest_degree)> all{};
};

// From those with j = 0; what would be of a higher degree stays 0.
MomentTable::Moments MomentTable::moments(const float* sums, int degree) const {
  Moments m;
  std::copy(sums, sums + monomials_to_degree(degree), m.all.begin());
  std::size_t before = 0, here = monomials_to_degree(far_degree_ + 1);
  for (int j = 1; 2 * j <= degree; ++j) {
    for (std::size_t i = 0; i < monomials_to_degree(degree - 2 * j); ++i) {
      const auto& [x, y, z] = times_squares[i];
      m.all[here + i] = m.all[before + x] + m.all[before + y] + m.all[before + z];
    }
    before = here;
    here += monomials_to_degree(far_degree_ + 1 - 2 * j);
  }
  return m;
}

void MomentTable::add(const float* f, const float* potential, FarField& far) const {
  far.degree = std::max(far.degree, far_degree_);
  const Moments of_f = moments(f, far_degree_), of_potential = moments(potential, far_degree_ + 1);
  for (std::size_t i = 0; i < field_terms_; ++i)
    far.f[terms_[i].monomial] += terms_[i].factor * of_f.all[terms_[i].moment];
  for (const Term& t : terms_) far.potential[t.monomial] += t.factor * of_potential.all[t.moment];
}

FarField FarField::of_child(int octant) const {
  FarField child = *this;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double shift = (octant >> axis) & 1 ? 0.5 : -0.5;
    shift_axis(child.f, degree, axis, shift);
    shift_axis(child.potential, degree + 1, axis, shift);
  }
  for (double& c : child.potential) c *= 2;  // F / half: half is now half as long
  return child;
}

FarField::Bounds FarField::bounds() const {
  Bounds b{f[0], f_error, {potential[1], potential[2], potential[3]}, gradient_error};
  for (std::size_t i = 1; i < monomials_to_degree(degree); ++i) b.f_variation += std::fabs(f[i]);
  // |grad x^a y^b z^c| <= a + b + c on the cube
  for (std::size_t i = 4; i < monomials_to_degree(degree + 1); ++i)
    b.gradient_variation += std::fabs(potential[i]) * monomials[i].degree();
  return b;
}

// The tail sum_{k>P} binom(n+k-1,k) q^k has growing ratio (n+k)/(k+1) q < 1 from some k on; it is summed
// until a geometric bound of the rest is below 1e-3 of the sum, and the bound is added.
double taylor_remainder(int exponent, int degree, double q) {
  if (q >= 1) return HUGE_VAL;
  double term = 1;
  for (int k = 0; k <= degree; ++k) term *= q * (exponent + k) / (k + 1);
  double sum = 0;
  for (int k = degree + 1; k < 4000; ++k) {
    sum += term;
    const double ratio = q * (exponent + k) / (k + 1);
    term *= ratio;
    if (ratio < 1 && term < 1e-3 * sum * (1 - ratio)) return sum + term / (1 - ratio);
  }
  return HUGE_VAL;
}

}  // namespace marrow
