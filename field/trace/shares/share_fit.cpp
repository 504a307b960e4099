#include "field/trace/shares/share_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "field/trace/kernels/strand_places.h"
#include "field/trace/sources/far_field.h"

namespace marrow {
namespace {

static_assert(SharePatch::coefficients == monomials_to_degree(SharePatch::degree));
constexpr int data_count = 4 * strand_places;
// Places count by their value and by their slopes, which are off by more.
constexpr double slope_weight = 0.3;

// Of a place: all monomials, and their slopes.
class MonomialPowers {
 public:
  explicit MonomialPowers(const Vec3d& z) {
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

// Least squares: coefficients from weighted data, four of each place: the value, then the slopes.
struct ShareFit {
  using Row = std::array<double, SharePatch::coefficients>;
  using Data = std::array<double, data_count>;
  std::array<Data, SharePatch::coefficients> basis{};  // what each monomial is at the places
  std::array<Row, data_count> coefficients{};          // of each datum

  ShareFit() {
    for (std::size_t i = 0; i < data_count; ++i) {
      const MonomialPowers at(place_in_cube(i / 4));
      for (std::size_t m = 0; m < SharePatch::coefficients; ++m)
        basis[m][i] = i % 4 == 0 ? at.value(monomials[m]) : slope_weight * at.slope(monomials[m], i % 4 - 1);
    }
    solve();
  }

 private:
  // (B^T B)^-1 B^T by elimination with the diagonal: the matrix is positive definite, its pivots stay above 0.3.
  void solve() {
    std::vector<std::array<double, SharePatch::coefficients + data_count>> rows(SharePatch::coefficients);
    for (std::size_t r = 0; r < SharePatch::coefficients; ++r) {
      for (std::size_t c = 0; c < SharePatch::coefficients; ++c)
        for (std::size_t i = 0; i < data_count; ++i) rows[r][c] += basis[r][i] * basis[c][i];
      for (std::size_t i = 0; i < data_count; ++i) rows[r][SharePatch::coefficients + i] = basis[r][i];
    }
    for (std::size_t c = 0; c < SharePatch::coefficients; ++c) {
      const double inverse = 1 / rows[c][c];
      for (double& v : rows[c]) v *= inverse;
      for (std::size_t r = 0; r < SharePatch::coefficients; ++r) {
        if (r == c) continue;
        const double factor = rows[r][c];
        for (std::size_t k = 0; k < rows[r].size(); ++k) rows[r][k] -= factor * rows[c][k];
      }
    }
    for (std::size_t i = 0; i < data_count; ++i)
      for (std::size_t m = 0; m < SharePatch::coefficients; ++m)
        coefficients[i][m] = rows[m][SharePatch::coefficients + i];
  }
};

using Data = ShareFit::Data;

Data data_of(const StrandShares& shares, const SharePatch& patch) {
  Data data{};
  const float half = 1 / patch.inverse_half;
  for (std::size_t k = 0; k < strand_places; ++k) {
    bool finite = std::isfinite(shares.share[k]);
    for (const auto& slope : shares.slope) finite = finite && std::isfinite(slope[k]);
    data[4 * k] = finite ? static_cast<double>(shares.share[k]) : 1;  // on a source, where all is inside
    for (std::size_t i = 0; i < 3; ++i)
      data[4 * k + 1 + i] = finite ? slope_weight * static_cast<double>(half * shares.slope[i][k]) : 0;
  }
  return data;
}

}  // namespace

double fit_share(const StrandShares& shares, SharePatch& patch) {
  const Data data = data_of(shares, patch);
  static const ShareFit fit;
  ShareFit::Row sum{};
  for (std::size_t i = 0; i < data_count; ++i)
    for (std::size_t m = 0; m < SharePatch::coefficients; ++m) sum[m] += data[i] * fit.coefficients[i][m];
  Data residual = data;
  for (std::size_t m = 0; m < SharePatch::coefficients; ++m)
    for (std::size_t i = 0; i < data_count; ++i) residual[i] -= fit.basis[m][i] * sum[m];
  double largest = 0;
  for (const double r : residual) largest = std::max(largest, std::fabs(r));
  for (std::size_t m = 0; m < SharePatch::coefficients; ++m) patch.coefficient[m] = static_cast<float>(sum[m]);
  return largest;
}

}  // namespace marrow
