#include "field/skeleton/tapered_plate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "field/kernel/inverse_family.h"
#include "field/math/elementary.h"
#include "field/math/matrix3.h"
#include "field/skeleton/border_terms.h"

namespace marrow {
namespace {

using Side = Plate::Side;
using Index = std::size_t;

// In units of 2^-53 of a value, which is then known to 2e-13.
constexpr double most_rounding = 2000;

// The exponents m of the distance: every second one from 2 or 3 to n + 5, the largest one of a second derivative.
struct Exponents {
  static constexpr Index most = 12;
  int n, first;
  Index count;

  explicit Exponents(int degree)
      : n(degree), first(degree % 2 == 0 ? 3 : 2), count(static_cast<Index>((degree + 5 - first) / 2 + 1)) {}
  int at(Index j) const { return first + 2 * static_cast<int>(j); }
  Index of(int m) const { return static_cast<Index>((m - first) / 2); }
  /// The highest power of tau that is asked for with it.
  Index last_power(Index j) const { return static_cast<Index>(std::min(at(j) - 2, n)); }
};
static_assert(Exponents::most == (max_kernel_degree + 5 - 3) / 2 + 1);

using ByExponent = std::array<double, Exponents::most>;
using Table = std::array<std::array<double, max_kernel_degree + 1>, Exponents::most>;  // ... and by power of tau

// What is gathered along the sides; the sizes are sums without signs.
struct SideSums {
  ByExponent plane{}, plane_size{};          // (m-2) T(0, m), or T(0, 2); over h^-(m-2) where it counts from the foot
  Table across{}, across_size{};             // (g out) int tau^k d^-(m-2)
  Vec3d out_plain, out_scaled, out_steeper;  // out int tau^(n-1) d^-(n+1), tau^n d^-(n+1), tau^n d^-(n+3)
  Matrix3 place_steeper;                     // int x out^T tau^n d^-(n+3)
};

// Adds what a node of a side gives of `plane`. For m = 2 the integral over the distance from the foot is a logarithm:
// of d / h, or of d over the least d.
void add_from_foot(double flat, double h2, double weight, const Exponents& exponents, std::span<double> sums) {
  const double inverse = 1 / (flat + h2), x = h2 * inverse, factor = weight * inverse;
  if (exponents.first == 3) return add_terms_from_foot(x, factor, 1, sums);
  const double y = flat * inverse;
  sums[0] += factor * 0.5 * (y > 0.5 ? -log(x) / y : y > 0 ? -log1p(-y) / y : 1);
  add_terms_from_foot(x, factor, 2, sums.subspan(1));
}

void add_from_border(double flat, double h2, double weight, double nearest2, const Exponents& exponents,
                     std::span<double> sums) {
  const double inverse = 1 / (flat + h2), factor = weight / flat;
  if (exponents.first == 3) return add_terms_of_border(inverse, factor, 1, sums);
  sums[0] -= 0.5 * factor * log(nearest2 * inverse);
  add_terms_of_border(inverse, factor, 2, sums.subspan(1));
}

// The integrals along one side.
struct Line {
  ByExponent plane{};
  Table moments{};  // int tau^k d^-(m-2)
  double plain = 0, scaled = 0, steeper = 0, steeper_along = 0;
};

Line line_of(const Plate& plate, const Side& side, const Exponents& exponents) {
  Line line;
  const int n = exponents.n;
  const double h2 = plate.height * plate.height, e2 = side.inside * side.inside;
  const double nearest2 = plate.beside * plate.beside + h2;
  const auto plane = std::span(line.plane).first(exponents.count);
  plate.for_each_node_of(side, n, [&](double t, double weight) {
    const double flat = t * t + e2, inverse = 1 / (flat + h2), tau = side.radius_at(t);
    if (plate.counts_from_foot()) add_from_foot(flat, h2, weight * side.inside, exponents, plane);
    else if (side.inside != 0) add_from_border(flat, h2, weight * side.inside, nearest2, exponents, plane);
    double power = exponents.first == 2 ? weight : weight * std::sqrt(inverse);
    for (Index j = 0; j < exponents.count; ++j, power *= inverse) {
      double term = power;
      for (Index k = 0; k < exponents.last_power(j); ++k, term *= tau) line.moments[j][k] += term;
    }
    const double plain = weight * integer_power(tau, n - 1) * half_power(inverse, kernel_degree(n, 2));
    line.plain += plain;
    line.scaled += plain * tau;
    line.steeper += plain * tau * inverse;
    line.steeper_along += plain * tau * inverse * t;
  });
  return line;
}

SideSums sums_along_sides(const Plate& plate, const Exponents& exponents) {
  SideSums sums;
  for (const Side& side : plate.sides) {
    const Line line = line_of(plate, side, exponents);
    const double steep = dot(plate.taper, side.out);
    for (Index j = 0; j < exponents.count; ++j) {
      sums.plane[j] += line.plane[j];
      sums.plane_size[j] += std::fabs(line.plane[j]);
      for (Index k = 0; k < exponents.last_power(j); ++k) {
        sums.across[j][k] += steep * line.moments[j][k];
        sums.across_size[j][k] += std::fabs(steep) * line.moments[j][k];
      }
    }
    sums.out_plain += side.out * line.plain;
    sums.out_scaled += side.out * line.scaled;
    sums.out_steeper += side.out * line.steeper;
    sums.place_steeper +=
        Matrix3::outer(side.out * (side.inside * line.steeper) + side.along * line.steeper_along, side.out);
  }
  return sums;
}

// T(e, m), and by how much they may be off, in units of 2^-53.
struct PlateMoments {
  Exponents exponents;
  Table values{}, rounding{};

  double operator()(int e, int m) const { return values[exponents.of(m)][static_cast<Index>(e)]; }
  bool is_known(int e, int m) const {
    const double off = rounding[exponents.of(m)][static_cast<Index>(e)];
    return off <= most_rounding * (*this)(e, m);
  }
};

PlateMoments moments_of(const Plate& plate, const Exponents& exponents, const SideSums& sums) {
  PlateMoments T{exponents};
  const double g2 = length_squared(plate.taper), tau = plate.tau_at_foot, h = std::fabs(plate.height);
  const bool from_foot = plate.counts_from_foot();
  double scale = from_foot && exponents.first == 3 ? 1 / h : 1;
  for (Index j = 0; j < exponents.count; ++j) {
    const int q = exponents.at(j) - 2;
    const double by = scale / std::max(q, 1);
    auto &value = T.values[j], &off = T.rounding[j];
    value[0] = by * sums.plane[j];
    off[0] = by * sums.plane_size[j];
    for (Index e = 1; e <= exponents.last_power(j); ++e) {
      double further = -sums.across[j][e - 1], further_off = sums.across_size[j][e - 1];
      if (e >= 2) {
        const double lower = static_cast<double>(e - 1) * g2;
        further += lower * T.values[j - 1][e - 2];
        further_off += lower * T.rounding[j - 1][e - 2];
      }
      value[e] = tau * value[e - 1] + further / q;
      off[e] = std::fabs(tau) * off[e - 1] + further_off / q + std::fabs(value[e]);
    }
    if (from_foot) scale /= h * h;
  }
  return T;
}

}  // namespace

// With v = height normal - x and the gradient of d^-m in the plane, -m x d^-(m+2), integrals of x and of x x^T become
// those of lower powers of tau and of the border.
template <Derivatives Order>
std::optional<SkeletonSample> tapered_plate_field(const Plate& plate, int n) {
  const Exponents exponents(n);
  const SideSums sums = sums_along_sides(plate, exponents);
  const PlateMoments T = moments_of(plate, exponents, sums);
  const int m = kernel_degree(n, 2);
  if (!(T.is_known(n - 1, m) && T.is_known(n - 2, m) && T.is_known(n - 1, m + 2) && T.is_known(n, m + 2) &&
        T.is_known(n, m + 4)))
    return {};
  const double h = plate.height, scale = 1 / surface_normalisation(n);
  const Vec3d &normal = plate.normal, &g = plate.taper;
  SkeletonSample sum;
  sum.value = scale * T(n - 1, m);
  if (!(sum.value <= field_ceiling)) return SkeletonSample::on_skeleton();
  sum.si_gradient = (normal * (-m * h * T(n, m + 2)) + g * (n * T(n - 1, m)) - sums.out_scaled) * scale;
  const Vec3d plain = g * ((n - 1) * T(n - 2, m)) - sums.out_plain;  // m int tau^(n-1) x d^-(m+2)
  if constexpr (Order >= Derivatives::First)
    sum.gradient = (normal * (-m * h * T(n - 1, m + 2)) + plain) * (scale / plate.unit);
  if constexpr (Order >= Derivatives::Second) {
    const Vec3d mixed = (g * (n * T(n - 1, m + 2)) - sums.out_steeper) * (-m * h);  // -m (m+2) h int tau^n x d^-(m+4)
    Matrix3 jacobian = Matrix3::outer(normal, normal * (m * ((m + 2) * h * h * T(n, m + 4) - T(n, m + 2))) + mixed);
    jacobian += Matrix3::outer(mixed, normal);
    jacobian += sums.place_steeper * -m + Matrix3::outer(plain * n, g);
    sum.si_jacobian = jacobian * (scale / plate.unit);
  }
  return sum;
}

template std::optional<SkeletonSample> tapered_plate_field<Derivatives::ScaleInvariant>(const Plate&, int);
template std::optional<SkeletonSample> tapered_plate_field<Derivatives::First>(const Plate&, int);
template std::optional<SkeletonSample> tapered_plate_field<Derivatives::Second>(const Plate&, int);

}  // namespace marrow
