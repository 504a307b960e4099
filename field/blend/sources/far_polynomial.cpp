// The polynomials by columns: all powers of z with the same powers of x and y are a polynomial of z, found by Horner's
// rule with its derivatives, four columns of either polynomial at a time.
#include "field/blend/sources/far_polynomial.h"

#include <algorithm>
#include <span>

namespace marrow {
namespace {

using Lanes = double __attribute__((vector_size(64)));
using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
using Block = FarPolynomial::Block;
static_assert(sizeof(Lanes) == FarPolynomial::lanes * sizeof(double));
constexpr int degree = FarPolynomial::degree;

// How many fours of columns have powers of x and y of this sum.
constexpr int fours_of(int sum) { return sum / 4 + 1; }

constexpr std::size_t block_count = [] {
  std::size_t n = 0;
  for (int sum = 0; sum <= degree; ++sum) n += static_cast<std::size_t>(fours_of(sum) * (degree - sum + 1));
  return n;
}();

// x^i and its derivatives for i from 0, with room for a last four.
struct Powers {
  static constexpr std::size_t size = degree + 5;
  double value[size] = {}, first[size] = {}, second[size] = {};
};

// At i, or, where they fall, at degree - i; 0 beyond.
[[gnu::always_inline]] inline void find_powers(double x, bool falling, Powers& out) {
  double power = 1, before = 0, twice_before = 0;
  for (int i = 0; i <= degree; ++i) {
    const int at = falling ? degree - i : i;
    out.value[at] = power;
    out.first[at] = i * before;
    out.second[at] = i * (i - 1) * twice_before;
    twice_before = before;
    before = power;
    power *= x;
  }
}

[[gnu::always_inline]] inline Lanes twice(const double* four) {
  const Four x = *reinterpret_cast<const Four*>(four);
  return __builtin_shufflevector(x, x, 0, 1, 2, 3, 0, 1, 2, 3);
}

struct Totals {
  Lanes value, gradient[3], hessian[6];
};

template <bool WithSlopes>
[[gnu::always_inline]] inline void fold(std::span<const Block> blocks, const Vec3d& at, Totals& out) {
  Powers of_x, of_y;
  find_powers(at.x, false, of_x);
  find_powers(at.y, true, of_y);
  Totals t{};
  const Block* block = blocks.data();
  for (int sum = 0; sum <= degree; ++sum)
    for (int four = 0; four < fours_of(sum); ++four) {
      Lanes v{}, first{}, second{};  // of the column; of the second derivative half
      for (int k = degree - sum; k >= 0; --k, ++block) {
        if (WithSlopes) second = second * at.z + first;
        first = first * at.z + v;
        v = v * at.z + *reinterpret_cast<const Lanes*>(&block->c[0]);
      }
      const int i = 4 * four, j = degree - sum + i;
      const Lanes x = twice(&of_x.value[i]), x1 = twice(&of_x.first[i]);
      const Lanes y = twice(&of_y.value[j]), y1 = twice(&of_y.first[j]), xy = x * y;
      t.value += v * xy;
      t.gradient[0] += v * (x1 * y);
      t.gradient[1] += v * (x * y1);
      t.gradient[2] += first * xy;
      if constexpr (WithSlopes) {
        t.hessian[0] += v * (twice(&of_x.second[i]) * y);
        t.hessian[1] += v * (x * twice(&of_y.second[j]));
        t.hessian[2] += second * xy;
        t.hessian[3] += first * (x * y1);
        t.hessian[4] += first * (x1 * y);
        t.hessian[5] += v * (x1 * y1);
      }
    }
  out = t;
}

[[gnu::target("avx512f,prefer-vector-width=512")]] void values_512(std::span<const Block> b, const Vec3d& x,
                                                                   Totals& out) {
  fold<false>(b, x, out);
}
[[gnu::target("avx512f,prefer-vector-width=512")]] void slopes_512(std::span<const Block> b, const Vec3d& x,
                                                                   Totals& out) {
  fold<true>(b, x, out);
}
[[gnu::target("avx2")]] void values_256(std::span<const Block> b, const Vec3d& x, Totals& out) {
  fold<false>(b, x, out);
}
[[gnu::target("avx2")]] void slopes_256(std::span<const Block> b, const Vec3d& x, Totals& out) {
  fold<true>(b, x, out);
}
void values_128(std::span<const Block> b, const Vec3d& x, Totals& out) { fold<false>(b, x, out); }
void slopes_128(std::span<const Block> b, const Vec3d& x, Totals& out) { fold<true>(b, x, out); }

struct Folds {
  void (*values)(std::span<const Block>, const Vec3d&, Totals&);
  void (*slopes)(std::span<const Block>, const Vec3d&, Totals&);
};

const Folds& folds() {
  static const Folds best = __builtin_cpu_supports("avx512f") ? Folds{values_512, slopes_512}
                            : __builtin_cpu_supports("avx2")  ? Folds{values_256, slopes_256}
                                                              : Folds{values_128, slopes_128};
  return best;
}

// visit(block, lane, place among the monomials) for each coefficient of f; that of h stands four lanes on.
template <class Visit>
void for_each_coefficient(const Visit& visit) {
  std::size_t block = 0;
  for (int sum = 0; sum <= degree; ++sum)
    for (int four = 0; four < fours_of(sum); ++four)
      for (int k = degree - sum; k >= 0; --k, ++block)
        for (int i = 4 * four; i <= std::min(sum, 4 * four + 3); ++i)
          visit(block, i - 4 * four, monomial_index(i, sum - i, k));
}

double of_f(const Lanes& v) { return ((v[0] + v[1]) + v[2]) + v[3]; }
double of_h(const Lanes& v) { return ((v[4] + v[5]) + v[6]) + v[7]; }
Vec3d of_f(const Lanes (&v)[3]) { return {of_f(v[0]), of_f(v[1]), of_f(v[2])}; }
Vec3d of_h(const Lanes (&v)[3]) { return {of_h(v[0]), of_h(v[1]), of_h(v[2])}; }

}  // namespace

FarPolynomial::Bounds& FarPolynomial::Bounds::operator+=(const Bounds& b) {
  f_error += b.f_error;
  S_error += b.S_error;
  steepest += b.steepest;
  second += b.second;
  S_second += b.S_second;
  log_slope = std::max(log_slope, b.log_slope);
  S_longest += b.S_longest;
  return *this;
}

FarPolynomial::FarPolynomial(const Vec3d& center, double radius, const Coefficients& f, const Coefficients& h,
                             const Bounds& bounds)
    : center_(center), radius_(radius), bounds_(bounds) {
  blocks_.resize(block_count);
  for_each_coefficient([&](std::size_t block, int lane, std::size_t monomial) {
    blocks_[block].c[lane] = f[monomial];
    blocks_[block].c[lane + 4] = h[monomial];
  });
}

SkeletonSample FarPolynomial::value_at(const Vec3d& p) const {
  Totals t;
  folds().values(blocks_, (p - center_) / radius_, t);
  SkeletonSample s;
  s.value = of_f(t.value);
  s.si_gradient = of_h(t.gradient) / radius_;
  return s;
}

MarkSums FarPolynomial::marks_at(const Vec3d& p) const {
  Totals t;
  folds().values(blocks_, (p - center_) / radius_, t);
  return {.first = of_f(t.value),
          .second = of_h(t.value),
          .first_gradient = of_f(t.gradient) / radius_,
          .second_gradient = of_h(t.gradient) / radius_};
}

SkeletonSample FarPolynomial::at(const Vec3d& p) const {
  Totals t;
  folds().slopes(blocks_, (p - center_) / radius_, t);
  SkeletonSample s;
  s.value = of_f(t.value);
  s.gradient = of_f(t.gradient) / radius_;
  s.si_gradient = of_h(t.gradient) / radius_;
  const double scale = 1 / (radius_ * radius_);
  const double yz = scale * of_h(t.hessian[3]), xz = scale * of_h(t.hessian[4]), xy = scale * of_h(t.hessian[5]);
  s.si_jacobian.rows = {Vec3d{scale * of_h(t.hessian[0]), xy, xz}, Vec3d{xy, scale * of_h(t.hessian[1]), yz},
                        Vec3d{xz, yz, 2 * scale * of_h(t.hessian[2])}};
  return s;
}

void FarPolynomial::add_to(const Vec3d& center, double radius, Coefficients& f, Coefficients& h) const {
  Coefficients own_f{}, own_h{};
  for_each_coefficient([&](std::size_t block, int lane, std::size_t monomial) {
    own_f[monomial] = blocks_[block].c[lane];
    own_h[monomial] = blocks_[block].c[lane + 4];
  });
  const Vec3d shift = (center - center_) / radius_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    move_axis<degree>(own_f, degree, axis, shift[axis], radius / radius_);
    move_axis<degree>(own_h, degree, axis, shift[axis], radius / radius_);
  }
  for (std::size_t i = 0; i < coefficient_count; ++i) {
    f[i] += own_f[i];
    h[i] += own_h[i];
  }
}

}  // namespace marrow
