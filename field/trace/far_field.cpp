#include "field/trace/far_field.h"

#include <cmath>

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

// Each monomial is a smaller one times a coordinate.
struct Step {
  std::size_t axis, from;
};

constexpr std::array<Step, monomial_count> make_steps() {
  std::array<Step, monomial_count> steps{};
  for (std::size_t i = 1; i < monomial_count; ++i) {
    const Monomial& m = table[i];
    steps[i] = m.a > 0   ? Step{0, index_of(m.a - 1, m.b, m.c)}
               : m.b > 0 ? Step{1, index_of(m.a, m.b - 1, m.c)}
                         : Step{2, index_of(m.a, m.b, m.c - 1)};
  }
  return steps;
}

constexpr auto step_table = make_steps();

constexpr std::size_t index_plus(const Monomial& m, int da, int db, int dc) {
  return index_of(m.a + da, m.b + db, m.c + dc);
}

// Moments stand in the order: degree-k tensors of r (k = 0..5), those that multiply |x|^2 (k = 0..3), and those
// that multiply |x|^4 (k = 0, 1).
constexpr std::size_t squared_begin = monomial_count, squared_count = monomials_to_degree(3),
                      quartic_begin = squared_begin + squared_count, quartic_count = monomials_to_degree(1);

using Moments = std::array<double, quartic_begin + quartic_count>;

void moments_to_polynomial(const Moments& t, Polynomial& p, std::size_t size) {
  const auto put = [&](std::size_t i, double v) {
    if (i < size) p[i] += v;
  };
  for (std::size_t i = 0; i < monomial_count; ++i) put(i, multinomial(table[i]) * t[i]);
  for (std::size_t i = 0; i < squared_count; ++i) {  // (x.r)^k |x|^2
    const Monomial& m = table[i];
    const double v = multinomial(m) * t[squared_begin + i];
    put(index_plus(m, 2, 0, 0), v);
    put(index_plus(m, 0, 2, 0), v);
    put(index_plus(m, 0, 0, 2), v);
  }
  for (std::size_t k = 0; k < quartic_count; ++k)  // (x.r)^k |x|^4
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        put(index_plus(table[k], (i == 0) * 2 + (j == 0) * 2, (i == 1) * 2 + (j == 1) * 2, (i == 2) * 2 + (j == 2) * 2),
            t[quartic_begin + k]);
}

// p(x) with x_axis = shift + x'_axis / 2, as a polynomial in x'.
void shift_axis(Polynomial& p, int axis, double shift) {
  constexpr std::array<std::array<double, 6>, 6> binomial{{{1, 0, 0, 0, 0, 0},
                                                          {1, 1, 0, 0, 0, 0},
                                                          {1, 2, 1, 0, 0, 0},
                                                          {1, 3, 3, 1, 0, 0},
                                                          {1, 4, 6, 4, 1, 0},
                                                          {1, 5, 10, 10, 5, 1}}};
  Polynomial q{};
  for (std::size_t i = 0; i < monomial_count; ++i) {
    Monomial m = table[i];
    int& e = axis == 0 ? m.a : axis == 1 ? m.b : m.c;
    const int exponent = e;
    double half_power = integer_power(0.5, exponent), shift_power = 1;
    for (int k = exponent; k >= 0; --k) {
      e = k;
      q[index_of(m.a, m.b, m.c)] +=
          p[i] * binomial[static_cast<std::size_t>(exponent)][static_cast<std::size_t>(k)] * half_power * shift_power;
      half_power *= 2;
      shift_power *= shift;
    }
  }
  p = q;
}

}  // namespace

const std::array<Monomial, monomial_count> monomials = table;

std::size_t monomial_index(int a, int b, int c) { return index_of(a, b, c); }

FarMoments::FarMoments(int exponent) : exponent_(exponent) {}

void FarMoments::add(const Vec3d& r, double weight, double radius) {
  empty_ = false;
  const double inv = 1 / length_squared(r), l = exponent_ / 2.0;
  const double base = (exponent_ % 2 ? std::sqrt(inv) : 1.0) * integer_power(inv, exponent_ / 2) * weight;
  // Gegenbauer: C_k^l(c) = sum_j (-1)^j (l)_(k-j) / (j! (k-2j)!) (2c)^(k-2j) with the rising factorial (l)_i.
  // With c = x.r / (|x| |r|) the term j multiplies (x.r)^(k-2j) |x|^(2j) by |r|^-(2k-2j) relative to |r|^-m.
  std::array<double, 6> rising{1}, power_of_two{1}, inverse{base};
  for (std::size_t i = 1; i < 6; ++i) {
    rising[i] = rising[i - 1] * (l + static_cast<double>(i) - 1);
    power_of_two[i] = 2 * power_of_two[i - 1];
    inverse[i] = inverse[i - 1] * inv;
  }
  const auto coefficient = [&](std::size_t tensor_degree, std::size_t j) {
    const std::size_t i = tensor_degree + j;  // k - j
    const double sign = j % 2 ? -1 : 1;
    return sign * rising[i] * power_of_two[tensor_degree] * inverse[i] /
           (factorial(static_cast<int>(j)) * factorial(static_cast<int>(tensor_degree)));
  };
  std::array<double, monomial_count> power;
  power[0] = 1;
  for (std::size_t i = 1; i < monomial_count; ++i) power[i] = r[step_table[i].axis] * power[step_table[i].from];
  const auto accumulate = [&](std::size_t begin, std::size_t j, int degree) {
    for (int k = 0; k <= degree; ++k) {
      const double c = coefficient(static_cast<std::size_t>(k), j);
      for (std::size_t i = first_of_degree(k); i < first_of_degree(k + 1); ++i) {
        const double value = c * power[i];
        f_[begin + i] += value;
        potential_[begin + i] += value * radius;
      }
    }
  };
  accumulate(0, 0, 5);
  accumulate(squared_begin, 1, 3);
  accumulate(quartic_begin, 2, 1);
}

void FarMoments::add_to(Polynomial& f, Polynomial& potential) const {
  moments_to_polynomial(f_, f, monomials_to_degree(field_degree));
  moments_to_polynomial(potential_, potential, monomial_count);
}

FarField FarField::of_child(int octant) const {
  FarField child = *this;
  for (int axis = 0; axis < 3; ++axis) {
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
  for (std::size_t i = 4; i < monomial_count; ++i)
    b.gradient_variation += std::fabs(potential[i]) * table[i].degree();
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
