#include "field/trace/share_patch.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "field/trace/far_field.h"
#include "field/trace/level_cache.h"
#include "field/trace/polynomial_bend.h"

namespace marrow {
namespace {

// The first of far_field.h.
constexpr std::size_t coefficient_count = monomials_to_degree(SharePatch::degree);
static_assert(coefficient_count == SharePatch::coefficients);
constexpr int data_count = 4 * strand_places;

// What a patch that is divided no further may be off, by the residuals of its fit. Where they are below it, the share
// was off by 3e-5 at most in 4000 hits of hair and of a creature, by 5e-6 in the median.
constexpr double largest_residual = 4e-5;
// At half the size a patch is off by 2^5 times less, as what it leaves out is of the fifth degree, and seldom by more
// than twice that. Where a part is off by more, 97 of 100 octants could not do with a patch (10,000 hairs; of 867 limbs
// 99).
constexpr double residual_ratio = 64;
// Places count by their value and by their slopes, which are off by more.
constexpr double slope_weight = 0.3;

// Of all monomials at a place.
class Monomials {
 public:
  explicit Monomials(const Vec3d& z) {
    for (std::size_t k = 0; k < 3; ++k) {
      powers_[k][0] = 1;
      for (std::size_t i = 1; i <= SharePatch::degree; ++i) powers_[k][i] = powers_[k][i - 1] * z[k];
    }
  }
  double value(const Monomial& m) const { return power(0, m) * power(1, m) * power(2, m); }
  double slope(const Monomial& m, std::size_t axis) const {
    const int n = exponent(axis, m);
    if (n == 0) return 0;
    const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
    return n * powers_[axis][static_cast<std::size_t>(n) - 1] * power(a, m) * power(b, m);
  }

 private:
  static int exponent(std::size_t axis, const Monomial& m) { return axis == 0 ? m.a : axis == 1 ? m.b : m.c; }
  double power(std::size_t axis, const Monomial& m) const {
    return powers_[axis][static_cast<std::size_t>(exponent(axis, m))];
  }
  double powers_[3][SharePatch::degree + 1];
};

Vec3d place(std::size_t k) {
  return {static_cast<double>(strand_place[k][0]), static_cast<double>(strand_place[k][1]),
          static_cast<double>(strand_place[k][2])};
}

// Least squares: coefficients from weighted data, four of each place: the value, then the slopes.
struct Fit {
  using Row = std::array<double, coefficient_count>;
  using Data = std::array<double, data_count>;
  std::array<Data, coefficient_count> basis{};  // what each monomial is at the places
  std::array<Row, data_count> coefficients{};   // of each datum

  Fit() {
    for (std::size_t i = 0; i < data_count; ++i) {
      const Monomials at(place(i / 4));
      for (std::size_t m = 0; m < coefficient_count; ++m)
        basis[m][i] = i % 4 == 0 ? at.value(monomials[m]) : slope_weight * at.slope(monomials[m], i % 4 - 1);
    }
    solve();
  }

 private:
  // (B^T B)^-1 B^T by elimination with the diagonal: the matrix is positive definite, its pivots stay above 0.3.
  void solve() {
    std::vector<std::array<double, coefficient_count + data_count>> rows(coefficient_count);
    for (std::size_t r = 0; r < coefficient_count; ++r) {
      for (std::size_t c = 0; c < coefficient_count; ++c)
        for (std::size_t i = 0; i < data_count; ++i) rows[r][c] += basis[r][i] * basis[c][i];
      for (std::size_t i = 0; i < data_count; ++i) rows[r][coefficient_count + i] = basis[r][i];
    }
    for (std::size_t c = 0; c < coefficient_count; ++c) {
      const double inverse = 1 / rows[c][c];
      for (double& v : rows[c]) v *= inverse;
      for (std::size_t r = 0; r < coefficient_count; ++r) {
        if (r == c) continue;
        const double factor = rows[r][c];
        for (std::size_t k = 0; k < rows[r].size(); ++k) rows[r][k] -= factor * rows[c][k];
      }
    }
    for (std::size_t i = 0; i < data_count; ++i)
      for (std::size_t m = 0; m < coefficient_count; ++m) coefficients[i][m] = rows[m][coefficient_count + i];
  }
};

const Fit& fit() {
  static const Fit made;
  return made;
}

using Data = Fit::Data;

// Of this thread, for as many strands as any level had.
float* memory_for(int strands) {
  thread_local LevelBuffer buffer;
  return buffer.allocate(static_cast<std::size_t>(strands) * floats_per_strand);
}

Data data_of(const BlockKernels& kernels, int degree, const FieldLevel& level, const SharePatch& patch) {
  Data data{};
  const float half = 1 / patch.inverse_half;
  StrandShares shares;
  kernels.strand_shares(level, degree, patch.center, half, memory_for(level.strands->count), shares);
  for (std::size_t k = 0; k < strand_places; ++k) {
    bool finite = std::isfinite(shares.share[k]);
    for (const auto& slope : shares.slope) finite = finite && std::isfinite(slope[k]);
    data[4 * k] = finite ? static_cast<double>(shares.share[k]) : 1;  // on a source, where all is inside
    for (std::size_t i = 0; i < 3; ++i)
      data[4 * k + 1 + i] = finite ? slope_weight * static_cast<double>(half * shares.slope[i][k]) : 0;
  }
  return data;
}

// Returns the largest residual.
double fit_patch(const Data& data, SharePatch& patch) {
  const Fit& fitted = fit();
  Fit::Row sum{};
  for (std::size_t i = 0; i < data_count; ++i)
    for (std::size_t m = 0; m < coefficient_count; ++m) sum[m] += data[i] * fitted.coefficients[i][m];
  Data residual = data;
  for (std::size_t m = 0; m < coefficient_count; ++m)
    for (std::size_t i = 0; i < data_count; ++i) residual[i] -= fitted.basis[m][i] * sum[m];
  double largest = 0;
  for (const double r : residual) largest = std::max(largest, std::fabs(r));
  for (std::size_t m = 0; m < coefficient_count; ++m) patch.coefficient[m] = static_cast<float>(sum[m]);
  return largest;
}

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
  for (std::size_t m = 0; m < coefficient_count; ++m) {
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

void find_line(SharePatch& patch, SharePart& part) {
  const auto [low, high] = range_beside_line(patch);
  double level = 0.5 * (low + high);
  for (std::size_t m = 0; m < coefficient_count; ++m) {
    const Monomial& p = monomials[m];
    if (p.degree() == 0) level += static_cast<double>(patch.coefficient[m]);
    if (p.degree() == 1) part.slope[p.a > 0 ? 0 : p.b > 0 ? 1 : 2] = patch.coefficient[m] * patch.inverse_half;
  }
  const double bend = polynomial_bend(coefficient_count, [&](std::size_t m) { return patch.coefficient[m]; });
  constexpr double rounding = 1e-6;
  part.level = static_cast<float>(level);
  part.bent = static_cast<float>(0.5 * (high - low) + rounding);
  patch.bend = static_cast<float>(bend * (1 + rounding)) * patch.inverse_half * patch.inverse_half;
}

// A monomial as z[axis] times one before it; its exponents, and the monomials with one factor less.
struct Factors {
  std::size_t axis, without[3];
  int exponent[3];

  constexpr explicit Factors(const Monomial& of) : axis(0), without{}, exponent{of.a, of.b, of.c} {
    for (std::size_t k = 0; k < 3; ++k) {
      if (exponent[k] == 0) continue;
      axis = k;
      without[k] = monomial_index(of.a - (k == 0), of.b - (k == 1), of.c - (k == 2));
    }
  }
};

// The value of a polynomial and its slopes, monomial after monomial.
struct ValueAndSlopes {
  const double (&z)[3];
  double of_monomial[coefficient_count] = {1};
  double value, slope[3] = {0, 0, 0};

  template <std::size_t... Monomials>
  ValueAndSlopes(const float (&coefficient)[coefficient_count], const double (&at)[3],
                 std::index_sequence<Monomials...>)
      : z(at), value(static_cast<double>(coefficient[0])) {
    (add<Monomials + 1>(static_cast<double>(coefficient[Monomials + 1])), ...);
  }

 private:
  template <std::size_t Number>
  void add(double c) {
    constexpr Factors f(monomials[Number]);
    of_monomial[Number] = of_monomial[f.without[f.axis]] * z[f.axis];
    value += c * of_monomial[Number];
    if constexpr (f.exponent[0] > 0) slope[0] += c * f.exponent[0] * of_monomial[f.without[0]];
    if constexpr (f.exponent[1] > 0) slope[1] += c * f.exponent[1] * of_monomial[f.without[1]];
    if constexpr (f.exponent[2] > 0) slope[2] += c * f.exponent[2] * of_monomial[f.without[2]];
  }
};

struct Cube {
  float center[3], half;
};
// The part that holds the slot of a path, by the highest bits of it.
Cube cube_of(int path, int shift) {
  Cube cube{.center = {0, 0, 0}, .half = 1};
  for (int s = SharePart::root_shift; s >= shift; s -= 3) {
    cube.half *= 0.5F;
    for (int k = 0; k < 3; ++k) cube.center[k] += (path >> s >> k & 1) != 0 ? cube.half : -cube.half;
  }
  return cube;
}

}  // namespace

void SharePatches::free_all(const Eight& eight) {
  for (const SharePart& part : eight.parts) {
    if (part.address == 0) continue;
    if ((part.address & SharePart::divided) == 0) {
      delete patch_at(part.address);
    } else {
      free_all(*parts_at(part.address));
      delete parts_at(part.address);
    }
  }
}

int SharePatches::path_to(const int (&layer)[3]) {
  int path = 0;
  for (int log2 = 2; log2 >= 0; --log2)
    for (int k = 2; k >= 0; --k) path = path << 1 | (layer[k] >> log2 & 1);
  return path;
}

bool SharePatches::is_far_off(float residual) {
  return static_cast<double>(residual) > residual_ratio * largest_residual;
}

std::uintptr_t SharePatches::divide(float residual, SharePart& to) const {
  static_assert(alignof(SharePatch) > SharePart::divided && alignof(Eight) > SharePart::divided);
  auto parts = std::make_unique<Eight>();
  SharePart part{.address = reinterpret_cast<std::uintptr_t>(parts.get()) + SharePart::divided, .bent = residual};
  return keep(part, std::move(parts), to);
}

std::uintptr_t SharePatches::fit_or_divide(const BlockKernels& kernels, int degree, const BlockLevel& strands, int path,
                                           int shift, SharePart& to) const {
  auto made = std::make_unique<SharePatch>();
  SharePatch& patch = *made;
  const Cube cube = cube_of(path, shift);
  patch.inverse_half = 1 / cube.half;
  for (int k = 0; k < 3; ++k) patch.center[k] = cube.center[k];
  const double residual = fit_patch(data_of(kernels, degree, strands.level, patch), patch);
  if (shift > 0 && residual > largest_residual) return divide(static_cast<float>(residual), to);
  patch.error = static_cast<float>(strands.angle_error + 2 * residual);  // it is off by more between places
  SharePart part{.address = reinterpret_cast<std::uintptr_t>(made.get()), .half = cube.half};
  find_line(patch, part);
  for (float known = error_.load(std::memory_order_relaxed);
       known < patch.error && !error_.compare_exchange_weak(known, patch.error, std::memory_order_relaxed);) {}
  return keep(part, std::move(made), to);
}

// Two threads may both have made it; one copy is kept.
template <class T>
std::uintptr_t SharePatches::keep(const SharePart& made, std::unique_ptr<T> owned, SharePart& to) const {
  const std::lock_guard lock(keeping_);
  if (to.address != 0) return to.address;
  bytes_.fetch_add(sizeof(T), std::memory_order_relaxed);
  owned.release();
  to.half = made.half;
  to.level = made.level;
  std::ranges::copy(made.slope, to.slope);
  to.bent = made.bent;
  std::atomic_ref(to.address).store(made.address, std::memory_order_release);
  return made.address;
}

ShareAt share_at(const SharePatch& patch, const Vec3d& at) {
  const double scale = static_cast<double>(patch.inverse_half);
  double z[3];
  for (std::size_t k = 0; k < 3; ++k) z[k] = (at[k] - static_cast<double>(patch.center[k])) * scale;
  const ValueAndSlopes at_z(patch.coefficient, z, std::make_index_sequence<coefficient_count - 1>());
  ShareAt out;
  out.share = at_z.value;
  for (std::size_t k = 0; k < 3; ++k) out.gradient[k] = at_z.slope[k] * scale;
  out.bend = static_cast<double>(patch.bend);
  out.error = static_cast<double>(patch.error);
  return out;
}

}  // namespace marrow
