#include "field/blend/local/far_expansion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "field/base/lazy.h"
#include "field/kernel/inverse_family.h"
#include "field/math/eight_doubles.h"
#include "field/math/elementary.h"
#include "field/math/moment_series.h"
#include "field/math/taylor_remainder.h"

namespace marrow {
namespace {

using Column = FarExpansion::Column;
constexpr int degree = FarPolynomial::degree;
constexpr std::size_t coefficient_count = FarPolynomial::coefficient_count;

// Nearer sources, over half the diagonal of the box, leave too much out for any field that counts.
constexpr double largest_ratio = 0.5;
constexpr std::size_t steps = 64, most_exponent = kernel_degree(max_kernel_degree, 2);

struct OfExponent {
  // taylor_remainder() of f and of grad_S f at the upper ends of steps of ratios up to the largest.
  std::array<double, steps> f, S;
  MomentSeries series;

  explicit OfExponent(int m) : series(m, degree) {
    for (std::size_t i = 0; i < steps; ++i) {
      const double q = static_cast<double>(i + 1) * (largest_ratio / steps);
      f[i] = taylor_remainder(m, degree, q);
      S[i] = taylor_remainder(m + 1, degree - 1, q);
    }
  }
};

const OfExponent& of_exponent(int m) {
  static std::array<Lazy<OfExponent>, most_exponent + 1> all;
  return all[static_cast<std::size_t>(m)].get([&] { return std::make_unique<const OfExponent>(m); });
}

// What sums of a batch need, and what they give: sums of w y^(tensor k), k <= highest.
struct Sums {
  const FarExpansion::Batch& of;
  const Column& weight;
  int groups, highest;
  double* out;
};

static_assert(width<Eight> == FarExpansion::lanes);

template <class Part>
[[gnu::always_inline]] inline const Part& in(const Column& c, int group, int lane) {
  return *reinterpret_cast<const Part*>(&c.of[group][lane]);
}

template <class Part>
[[gnu::always_inline]] inline void multiply(Column& by, const Column& factor, int groups) {
  for (int g = 0; g < groups; ++g)
    for (int lane = 0; lane < FarExpansion::lanes; lane += width<Part>)
      *reinterpret_cast<Part*>(&by.of[g][lane]) *= in<Part>(factor, g, lane);
}

// Those with the same powers of x and y, which stand in `start` with the weight, and those of z up to Highest. Lanes
// are added up in the same order whatever the width.
template <class Part, int Highest>
[[gnu::always_inline]] inline void sum_column(const Column& start, const Column& z, int groups, double*(&out)) {
  alignas(sizeof(Eight)) double lanes[Highest + 1][FarExpansion::lanes];
  for (int lane = 0; lane < FarExpansion::lanes; lane += width<Part>) {
    Part sums[Highest + 1]{};
    for (int g = 0; g < groups; ++g) {
      Part p = in<Part>(start, g, lane);
      for (int c = 0; c < Highest; ++c) {
        sums[c] += p;
        p *= in<Part>(z, g, lane);
      }
      sums[Highest] += p;
    }
    for (int c = 0; c <= Highest; ++c) *reinterpret_cast<Part*>(&lanes[c][lane]) = sums[c];
  }
  for (const auto& s : lanes) *out++ = ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
}

template <class Part, std::size_t... Highest>
[[gnu::always_inline]] inline void sum_column_to(int highest, const Column& start, const Column& z, int groups,
                                                 double*(&out), std::index_sequence<Highest...>) {
  (void)((highest == static_cast<int>(Highest) &&
          (sum_column<Part, static_cast<int>(Highest)>(start, z, groups, out), true)) ||
         ...);
}

// A column after the other, by the power of x, then of y.
template <class Part>
[[gnu::always_inline]] inline void sum_columns(const Sums& s) {
  Column of_x = s.weight;
  double* out = s.out;
  for (int a = 0; a <= s.highest; ++a) {
    Column of_xy = of_x;
    for (int b = 0; a + b <= s.highest; ++b) {
      sum_column_to<Part>(s.highest - a - b, of_xy, s.of.z, s.groups, out, std::make_index_sequence<degree + 1>());
      multiply<Part>(of_xy, s.of.y, s.groups);
    }
    multiply<Part>(of_x, s.of.x, s.groups);
  }
}

[[gnu::target("avx512f,prefer-vector-width=512")]] void sum_columns_512(const Sums& s) { sum_columns<Eight>(s); }
[[gnu::target("avx2")]] void sum_columns_256(const Sums& s) { sum_columns<Four>(s); }
void sum_columns_128(const Sums& s) { sum_columns<Two>(s); }

// Adds them, in the order of monomials.
void sum_moments(const FarExpansion::Batch& batch, const Column& weight, int highest, double* to) {
  static const auto best = __builtin_cpu_supports("avx512f") ? sum_columns_512
                           : __builtin_cpu_supports("avx2")  ? sum_columns_256
                                                             : sum_columns_128;
  std::array<double, coefficient_count> columns;
  best({batch, weight, (batch.count + FarExpansion::lanes - 1) / FarExpansion::lanes, highest, columns.data()});
  const double* next = columns.data();
  for (int a = 0; a <= highest; ++a)
    for (int b = 0; a + b <= highest; ++b)
      for (int c = 0; a + b + c <= highest; ++c) to[monomial_index(a, b, c)] += *next++;
}

void multiply(Column& by, const Column& factor) {
  for (int g = 0; g < FarExpansion::most_groups; ++g)
    for (int i = 0; i < FarExpansion::lanes; ++i) by.of[g][i] *= factor.of[g][i];
}

}  // namespace

FarExpansion::FarExpansion(const Box3& box, bool lifted, bool marked, double error, double share)
    : center_(box.center()),
      rho_(0.5 * length(box.size()) * (1 + 1e-12)),
      error_(error),
      share_(share),
      lifted_(lifted),
      marked_(marked) {}

std::optional<FarExpansion::View> FarExpansion::seen(const Source& s, int exponent) const {
  const Vec3d away = s.at - center_;
  const double squared = dot(away, away) + s.lift_squared;
  if (!(rho_ > 0 && squared * (largest_ratio * largest_ratio) > rho_ * rho_)) return {};
  const double distance = std::sqrt(squared), inverse = 1 / squared;
  double field = exponent % 2 == 0 ? s.weight : s.weight / distance;  // power by power, so that none overflows
  for (int i = 0; i < exponent / 2; ++i) field *= inverse;
  const auto step = std::min(static_cast<std::size_t>(rho_ / distance * (steps / largest_ratio)), steps - 1);
  const OfExponent& of = of_exponent(exponent);
  if (!(of.S[step] * field <= error_ * std::max(std::min(1.0, field), share_))) return {};
  return View{distance, field, of.f[step], of.S[step]};
}

void FarExpansion::add(const Source& s, int exponent, const View& view) {
  if (!batch_) batch_ = std::make_unique<Batch>();
  Batch& b = *batch_;
  if (b.count == most_groups * lanes) fold();
  if (exponent != exponent_) expand();
  exponent_ = exponent;
  const double D = view.distance / rho_, inverse = 1 / (D * D), m = exponent;
  const Vec3d y = (s.at - center_) / rho_ * inverse;
  const int group = b.count / lanes, lane = b.count % lanes;
  b.x.of[group][lane] = y.x;
  b.y.of[group][lane] = y.y;
  b.z.of[group][lane] = y.z;
  b.inverse.of[group][lane] = inverse;
  b.field.of[group][lane] = view.field;
  b.radius.of[group][lane] = s.radius;
  b.mark.of[group][lane] = s.mark;
  ++b.count;

  const double slope = m / view.distance, shrink = (1 + 1e-12) / (1 - 1 / D);
  const double steep = slope * view.field * integer_power(shrink, exponent + 1);
  const double bent = steep * (m + 1) * shrink / view.distance;
  bounds_.f_error += view.field * view.f_remainder;
  bounds_.S_error += slope * s.radius * view.field * view.S_remainder;
  bounds_.steepest += steep;
  bounds_.S_longest += steep * s.radius;
  bounds_.second += bent;
  bounds_.S_second += bent * s.radius * (m + 2) * shrink / view.distance;
  bounds_.log_slope = std::max(bounds_.log_slope, slope * shrink);
}

void FarExpansion::add_to(Moments& moments, Column weight) const {
  moments.resize(MomentSeries::count(degree));
  const MomentSeries& series = of_exponent(exponent_).series;
  sum_moments(*batch_, weight, degree, moments.data());
  for (int j = 1; lifted_ && 2 * j <= degree; ++j) {
    multiply(weight, batch_->inverse);
    sum_moments(*batch_, weight, degree - 2 * j, &moments[series.first(j)]);
  }
}

// The batch to the moments.
void FarExpansion::fold() {
  add_to(f_moments_, batch_->field);
  multiply(batch_->radius, batch_->field);
  add_to(h_moments_, batch_->radius);
  if (marked_) {
    Column weight = batch_->field;
    multiply(weight, batch_->mark);
    add_to(first_moments_, weight);
    multiply(weight, batch_->mark);
    add_to(second_moments_, weight);
  }
  *batch_ = {};
}

// All sources of one exponent to the polynomials.
void FarExpansion::expand() {
  if (batch_->count > 0) fold();
  expand(f_moments_, f_);
  expand(h_moments_, h_);
  expand(first_moments_, first_);
  expand(second_moments_, second_);
}

void FarExpansion::expand(Moments& moments, FarPolynomial::Coefficients& to) const {
  if (moments.empty()) return;
  const MomentSeries& series = of_exponent(exponent_).series;
  if (!lifted_) series.complete(moments, degree);
  series.add_to(to, moments, degree);
  moments.clear();
}

std::unique_ptr<const FarPolynomial> FarExpansion::polynomial(const FarPolynomial* outer) {
  if (batch_) expand();
  FarPolynomial::Bounds bounds = bounds_;
  if (outer != nullptr) {
    outer->add_to(center_, rho_, f_, h_);
    bounds += outer->bounds();
  }
  return std::make_unique<const FarPolynomial>(center_, rho_, f_, h_, bounds);
}

std::unique_ptr<const FarPolynomial> FarExpansion::marks(const FarPolynomial* outer) const {
  FarPolynomial::Coefficients first = first_, second = second_;
  if (outer != nullptr) outer->add_to(center_, rho_, first, second);
  return std::make_unique<const FarPolynomial>(center_, rho_, first, second, FarPolynomial::Bounds{});
}

}  // namespace marrow
