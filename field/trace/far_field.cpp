#include "field/trace/far_field.h"

#include <cmath>
#include <cstdint>

#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr std::array<Monomial, monomial_count> make_monomials() {
  std::array<Monomial, monomial_count> m{};
  std::size_t i = 0;
  for (int d = 0; d <= potential_degree; ++d)
    for (int a = d; a >= 0; --a)
      for (int b = d - a; b >= 0; --b) m[i++] = {a, b, d - a - b};
  return m;
}

constexpr auto table = make_monomials();

constexpr std::size_t first_of_degree(int d) { return static_cast<std::size_t>(d * (d + 1) * (d + 2) / 6); }

constexpr std::size_t index_of(int a, int b, int c) {
  const int d = a + b + c, rest = d - a;
  return first_of_degree(d) + static_cast<std::size_t>(rest * (rest + 1) / 2 + rest - b);
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

// Adds sum_k constant (x.r)^k |x|^(2j) for one j, whose moments begin at `t`; only terms that p can hold.
void add_terms(const float* t, int j, int highest_tensor, double l, std::size_t size, Polynomial& p) {
  for (std::size_t i = 0; i < monomials_to_degree(highest_tensor); ++i) {
    const Monomial& m = table[i];
    if (monomials_to_degree(m.degree() + 2 * j) > size) continue;
    const double v = gegenbauer_constant(l, m.degree(), j) * multinomial(m) * static_cast<double>(t[i]);
    // |x|^(2j) as a sum of products of j squares of coordinates
    for (int a = 0; a < (j > 0 ? 3 : 1); ++a)
      for (int b = 0; b < (j > 1 ? 3 : 1); ++b) {
        int e[3] = {m.a, m.b, m.c};
        if (j > 0) e[a] += 2;
        if (j > 1) e[b] += 2;
        p[index_of(e[0], e[1], e[2])] += v;
      }
  }
}

void moments_to_polynomial(const Moments& t, int exponent, std::size_t size, Polynomial& p) {
  const double l = exponent / 2.0;
  add_terms(t.data(), 0, 5, l, size, p);
  add_terms(t.data() + 56, 1, 3, l, size, p);
  add_terms(t.data() + 76, 2, 1, l, size, p);
}

// Monomials that differ only in the exponent of one axis, in its order: a polynomial of that axis alone.
struct Line {
  std::array<std::uint8_t, potential_degree + 1> at{};
  int size = 0;
};
constexpr std::size_t line_count = 21;  // pairs of exponents of the other two axes with sum <= 5

constexpr std::array<std::array<Line, line_count>, 3> make_lines() {
  std::array<std::array<Line, line_count>, 3> lines{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::size_t n = 0;
    for (int p = 0; p <= potential_degree; ++p)
      for (int q = 0; p + q <= potential_degree; ++q, ++n)
        for (int e = 0; e + p + q <= potential_degree; ++e) {
          Line& line = lines[axis][n];
          line.at[static_cast<std::size_t>(line.size++)] = static_cast<std::uint8_t>(axis == 0   ? index_of(e, p, q)
                                                                                     : axis == 1 ? index_of(p, e, q)
                                                                                                 : index_of(p, q, e));
        }
  }
  return lines;
}

constexpr auto axis_lines = make_lines();

// p(x) with x_axis = shift + x'_axis / 2, as a polynomial in x': repeated synthetic division along each line.
void shift_axis(Polynomial& p, std::size_t axis, double shift) {
  for (const Line& line : axis_lines[axis]) {
    std::array<double, potential_degree + 1> c;
    for (int i = 0; i < line.size; ++i) c[static_cast<std::size_t>(i)] = p[line.at[static_cast<std::size_t>(i)]];
    for (int begin = 0; begin + 1 < line.size; ++begin)
      for (int i = line.size - 2; i >= begin; --i)
        c[static_cast<std::size_t>(i)] += shift * c[static_cast<std::size_t>(i) + 1];
    double scale = 1;
    for (int i = 0; i < line.size; ++i, scale *= 0.5)
      p[line.at[static_cast<std::size_t>(i)]] = c[static_cast<std::size_t>(i)] * scale;
  }
}

}  // namespace

const std::array<Monomial, monomial_count> monomials = table;

std::size_t monomial_index(int a, int b, int c) { return index_of(a, b, c); }

void add_moments(const Moments& f, const Moments& potential, int exponent, FarField& far) {
  moments_to_polynomial(f, exponent, monomials_to_degree(field_degree), far.f);
  moments_to_polynomial(potential, exponent, monomial_count, far.potential);
}

FarField FarField::of_child(int octant) const {
  FarField child = *this;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double shift = (octant >> axis) & 1 ? 0.5 : -0.5;
    shift_axis(child.f, axis, shift);
    shift_axis(child.potential, axis, shift);
  }
  for (double& c : child.potential) c *= 2;  // F / half: half is now half as long
  return child;
}

FarField::Bounds FarField::bounds() const {
  Bounds b{f[0], f_error, {potential[1], potential[2], potential[3]}, gradient_error};
  for (std::size_t i = 1; i < monomial_count; ++i) b.f_variation += std::fabs(f[i]);
  // |grad x^a y^b z^c| <= a + b + c on the cube
  for (std::size_t i = 4; i < monomial_count; ++i) b.gradient_variation += std::fabs(potential[i]) * table[i].degree();
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
