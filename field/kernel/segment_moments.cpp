// Moments of a segment by one Gauss rule, by closed forms, or by graded panels.
#include "field/kernel/segment_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "field/kernel/inverse_family.h"
#include "field/kernel/power_integrals.h"
#include "field/math/gauss_rule.h"

namespace marrow {
namespace {

// A rule with N nodes on a length L seen from a distance D errs by about rho^-2N, where rho = z + sqrt(z^2 + 1),
// z = 2 D / L, is the Bernstein ellipse through the nearest pole t = +-i h. 20 nodes at D = 0.8 L give 2e-22 times
// a factor that grows with the degree; the others are placed at the same rho^-2N.
constexpr double distance_for_20 = 0.8, distance_for_12 = 2, distance_for_8 = 6, distance_for_6 = 17;

// tau^n grows to (1 + rho/2)^n on that ellipse when the radius falls to 0 along the segment, so that the error is
// rho^-2N (1 + rho/2)^n: below 1e-14 at the distances above for n < N.
template <std::size_t Count>
bool holds_radius_power(const SegmentView& view, int n) {
  return view.slope == 0 || n < static_cast<int>(Count);
}

// Above this degree the binomial sums of the closed form lose more digits than panels do.
constexpr int max_closed_form_degree = 8;

// Sums in two lanes that a compiler can keep in a vector register; the order of additions is fixed.
template <std::size_t Count>
double lane_sum(const std::array<double, Count>& terms) {
  static_assert(Count % 2 == 0);
  std::array<double, 2> lanes{terms[0], terms[1]};
  for (std::size_t i = 2; i < Count; i += 2)
    for (std::size_t k = 0; k < 2; ++k) lanes[k] += terms[i + k];
  return lanes[0] + lanes[1];
}

template <std::size_t Count>
double lane_sum(const std::array<double, Count>& terms, const std::array<double, Count>& factors) {
  std::array<double, Count> products;
  for (std::size_t i = 0; i < Count; ++i) products[i] = terms[i] * factors[i];
  return lane_sum(products);
}

// Gauss-Legendre over [begin, begin + length] of the line.
template <Derivatives Order, std::size_t Count>
void add_rule(const SegmentView& view, double begin, double length, int n, int dimension, SegmentMoments& sum) {
  constexpr auto& rule = gauss_rule<Count>;
  const bool even = n % 2 == 0;
  std::array<double, Count> t, tau, inverse, ratio, term;
  for (std::size_t i = 0; i < Count; ++i) {
    t[i] = begin + length * rule.nodes[i];
    tau[i] = view.radius1 + view.slope * (t[i] - view.t1);
    inverse[i] = 1 / (t[i] * t[i] + view.h_squared);
    ratio[i] = tau[i] * tau[i] * inverse[i];
  }
  // tau^(n-1) d^-n = (tau/d)^(n-2) tau/d^2 for even n, (tau/d)^(n-1) / d for odd n
  if (even)
    for (std::size_t i = 0; i < Count; ++i) term[i] = rule.weights[i] * length * (tau[i] * inverse[i]);
  else
    for (std::size_t i = 0; i < Count; ++i) term[i] = rule.weights[i] * length * std::sqrt(inverse[i]);
  for (int k = 0; k < (n - 1) / 2; ++k)
    for (std::size_t i = 0; i < Count; ++i) term[i] *= ratio[i];
  if (dimension == 2)
    for (std::size_t i = 0; i < Count; ++i) term[i] /= tau[i];
  sum.value += lane_sum(term);
  for (std::size_t i = 0; i < Count; ++i) term[i] *= inverse[i];
  if constexpr (Order >= Derivatives::First) {
    sum.first[0] += lane_sum(term);
    sum.first[1] += lane_sum(term, t);
  }
  for (std::size_t i = 0; i < Count; ++i) term[i] *= tau[i];
  sum.si[0] += lane_sum(term);
  sum.si[1] += lane_sum(term, t);
  if constexpr (Order >= Derivatives::Second) {
    for (std::size_t i = 0; i < Count; ++i) term[i] *= inverse[i];
    sum.second[0] += lane_sum(term);
    for (std::size_t i = 0; i < Count; ++i) term[i] *= t[i];
    sum.second[1] += lane_sum(term);
    sum.second[2] += lane_sum(term, t);
  }
}

// The panel [begin, begin + length] whose distance from the point is `distance` >= 0.8 length.
template <Derivatives Order>
void add_panel(const SegmentView& view, double begin, double length, double distance, int n, int dimension,
               SegmentMoments& sum) {
  if (distance >= distance_for_6 * length && holds_radius_power<6>(view, n))
    add_rule<Order, 6>(view, begin, length, n, dimension, sum);
  else if (distance >= distance_for_8 * length && holds_radius_power<8>(view, n))
    add_rule<Order, 8>(view, begin, length, n, dimension, sum);
  else if (distance >= distance_for_12 * length && holds_radius_power<12>(view, n))
    add_rule<Order, 12>(view, begin, length, n, dimension, sum);
  else add_rule<Order, 20>(view, begin, length, n, dimension, sum);
}

// Panels from `near` to `far`, where |t| grows; each is as long as its distance from the point allows. Nearer to the
// line than squares can tell (1e-162) the value is infinite, and nothing else counts.
template <Derivatives Order>
void add_graded_panels(const SegmentView& view, double near, double far, int n, int dimension, SegmentMoments& sum) {
  const double direction = far < near ? -1 : 1;
  double begin = near, rest = std::fabs(far - near);
  while (rest > 0) {
    const double distance = std::sqrt(begin * begin + view.h_squared);
    const double length = std::min(rest, distance / distance_for_20);
    if (!(length > 0)) {
      sum.value = std::numeric_limits<double>::infinity();
      return;
    }
    if (direction > 0) add_panel<Order>(view, begin, length, distance, n, dimension, sum);
    else add_panel<Order>(view, begin - length, length, distance, n, dimension, sum);
    begin += direction * length;
    rest -= length;
  }
}

bool foot_is_inside(const SegmentView& view) { return view.t1 < 0 && view.t2 > 0; }

double distance_to(const SegmentView& view) {
  const double t = foot_is_inside(view) ? 0 : std::min(std::fabs(view.t1), std::fabs(view.t2));
  return std::sqrt(t * t + view.h_squared);
}

// The coefficients binom(e, k) tau_f^(e-k) slope^k of (tau_f + slope t)^e.
class RadiusPower {
 public:
  RadiusPower(const SegmentView& view, int exponent) : last_(view.slope == 0 ? 0 : exponent) {
    std::array<double, max_kernel_degree + 1> base{1};
    for (std::size_t k = 1; k <= static_cast<std::size_t>(exponent); ++k) base[k] = base[k - 1] * view.radius_at_foot;
    double factor = 1;
    for (int k = 0; k <= last_; ++k) {
      coefficients_[static_cast<std::size_t>(k)] = factor * base[static_cast<std::size_t>(exponent - k)];
      factor *= view.slope * (exponent - k) / (k + 1);
    }
  }
  int degree() const { return last_; }
  // The integral of tau^e t^j d^-m.
  double moment(const PowerIntegrals& J, int j, int m) const {
    double sum = 0;
    for (int k = 0; k <= last_; ++k) sum += coefficients_[static_cast<std::size_t>(k)] * J(k + j, m);
    return sum;
  }

 private:
  int last_;
  std::array<double, max_kernel_degree + 1> coefficients_;
};

}  // namespace

template <Derivatives Order>
SegmentMoments segment_moments_by_panels(const SegmentView& view, int n, int dimension) {
  SegmentMoments sum;
  if (foot_is_inside(view)) {
    add_graded_panels<Order>(view, 0, view.t1, n, dimension, sum);
    add_graded_panels<Order>(view, 0, view.t2, n, dimension, sum);
  } else if (view.t1 >= 0) {
    add_graded_panels<Order>(view, view.t1, view.t2, n, dimension, sum);
  } else {
    add_graded_panels<Order>(view, view.t2, view.t1, n, dimension, sum);
  }
  return sum;
}

template <Derivatives Order>
SegmentMoments segment_moments_by_recurrence(const SegmentView& view, int n, int dimension) {
  const RadiusPower plain(view, n - dimension), raised(view, n - dimension + 1);
  const PowerIntegrals J(view.t1, view.t2, view.h_squared, Order == Derivatives::Second ? n + 4 : n + 2, n,
                         raised.degree());
  SegmentMoments sum;
  sum.value = plain.moment(J, 0, n);
  if constexpr (Order >= Derivatives::First)
    for (int j = 0; j < 2; ++j) sum.first[j] = plain.moment(J, j, n + 2);
  for (int j = 0; j < 2; ++j) sum.si[j] = raised.moment(J, j, n + 2);
  if constexpr (Order >= Derivatives::Second)
    for (int j = 0; j < 3; ++j) sum.second[j] = raised.moment(J, j, n + 4);
  return sum;
}

template <Derivatives Order>
SegmentMoments segment_moments(const SegmentView& view, int n, int dimension) {
  const double distance = distance_to(view);
  if (distance >= distance_for_20 * view.length()) {
    SegmentMoments sum;
    add_panel<Order>(view, view.t1, view.length(), distance, n, dimension, sum);
    return sum;
  }
  if (foot_is_inside(view) && n <= max_closed_form_degree)
    return segment_moments_by_recurrence<Order>(view, n, dimension);
  return segment_moments_by_panels<Order>(view, n, dimension);
}

template SegmentMoments segment_moments<Derivatives::ScaleInvariant>(const SegmentView&, int, int);
template SegmentMoments segment_moments<Derivatives::First>(const SegmentView&, int, int);
template SegmentMoments segment_moments<Derivatives::Second>(const SegmentView&, int, int);
template SegmentMoments segment_moments_by_panels<Derivatives::Second>(const SegmentView&, int, int);
template SegmentMoments segment_moments_by_recurrence<Derivatives::Second>(const SegmentView&, int, int);

}  // namespace marrow
