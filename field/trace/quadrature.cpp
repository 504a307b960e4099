#include "field/trace/quadrature.h"

#include <utility>

#include "field/math/elementary.h"
#include "field/math/gauss_rule.h"

namespace marrow {
namespace {

template <std::size_t... Counts>
constexpr std::array<GaussNodes, sizeof...(Counts)> all_rules(std::index_sequence<Counts...>) {
  return {GaussNodes{gauss_rule<Counts + 1>.nodes, gauss_rule<Counts + 1>.weights}...};
}

double binomial(int n, int k) {
  double b = 1;
  for (int i = 1; i <= k; ++i) b *= static_cast<double>(n - k + i) / i;
  return b;
}

}  // namespace

GaussNodes gauss_legendre(int count) {
  static constexpr auto rules = all_rules(std::make_index_sequence<max_gauss_nodes>());
  return rules[static_cast<std::size_t>(count - 1)];
}

GaussError::GaussError(int degree) : degree_(degree) {
  // c_m = (m!)^4 / ((2m+1) ((2m)!)^2) = 1 / ((2m+1) binom(2m, m)^2)
  for (int m = 1; m <= max_gauss_nodes; ++m) {
    const double central = binomial(2 * m, m);
    const double c = 1 / ((2 * m + 1) * central * central);
    field_[static_cast<std::size_t>(m)] = c * binomial(degree + 2 * m - 1, 2 * m);
    gradient_[static_cast<std::size_t>(m)] = c * degree * binomial(degree + 2 * m, 2 * m);
  }
}

namespace {

// What does not depend on the number of nodes.
struct Scales {
  double shrink, field, gradient;  // (length / distance)^2, and the factors of field_ and gradient_
};

Scales scales(int degree, double mass, double largest_radius, double slope, double length, double distance) {
  const double ratio = length / distance, taper = 1 + slope * distance / largest_radius;
  const double field = mass * integer_power(taper, degree - 1) / integer_power(distance, degree);
  return {ratio * ratio, field, field * taper * largest_radius / distance};
}

}  // namespace

GaussError::Bound GaussError::bound(int nodes, double mass, double largest_radius, double slope, double length,
                                    double distance) const {
  const Scales s = scales(degree_, mass, largest_radius, slope, length, distance);
  const double shrink = integer_power(s.shrink, nodes);
  const auto m = static_cast<std::size_t>(nodes);
  return {field_[m] * s.field * shrink, gradient_[m] * s.gradient * shrink};
}

GaussError::Rule GaussError::smallest_rule(double mass, double largest_radius, double slope, double length,
                                           double distance, Bound allowed) const {
  Scales s = scales(degree_, mass, largest_radius, slope, length, distance);
  for (int m = 1;; ++m) {
    s.field *= s.shrink;
    s.gradient *= s.shrink;
    const Bound b{field_[static_cast<std::size_t>(m)] * s.field, gradient_[static_cast<std::size_t>(m)] * s.gradient};
    const bool within = b.field <= allowed.field && b.gradient <= allowed.gradient;
    if (within || m == max_gauss_nodes) return {m, b, within};
  }
}

}  // namespace marrow
