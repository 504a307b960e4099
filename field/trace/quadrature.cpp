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

GaussError::Bound GaussError::bound(int nodes, double mass, double largest_radius, double slope, double length,
                                    double distance) const {
  const double ratio = length / distance;
  const double shrink = integer_power(ratio * ratio, nodes);
  const double taper = 1 + slope * distance / largest_radius;
  const double taper_power = integer_power(taper, degree_ - 1);
  const double base = mass * shrink * taper_power / integer_power(distance, degree_);
  const auto m = static_cast<std::size_t>(nodes);
  return {field_[m] * base, gradient_[m] * base * taper * largest_radius / distance};
}

}  // namespace marrow
