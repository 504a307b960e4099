// Gauss-Legendre rules computed by the compiler, in structure-of-arrays form for vector loops.
#pragma once

#include <array>
#include <cstddef>

namespace marrow {

/// Nodes in (0, 1), weights with sum 1. Exact for polynomials of degree 2 Count - 1.
template <std::size_t Count>
struct GaussRule {
  std::array<double, Count> nodes{}, weights{};
};

namespace detail {

struct LegendreValue {
  long double value, derivative;
};

// Bonnet's recurrence; x strictly between -1 and 1 or above 1.
consteval LegendreValue legendre(std::size_t degree, long double x) {
  long double previous = 1, current = x;
  for (std::size_t k = 2; k <= degree; ++k) {
    const auto order = static_cast<long double>(k);
    const long double next = ((2 * order - 1) * x * current - (order - 1) * previous) / order;
    previous = current;
    current = next;
  }
  return {current, static_cast<long double>(degree) * (x * current - previous) / (x * x - 1)};
}

}  // namespace detail

/// Newton's iteration with the roots found so far divided out: from the right of all remaining roots it falls
/// monotonically onto the largest, so no guess is needed.
template <std::size_t Count>
consteval GaussRule<Count> make_gauss_rule() {
  GaussRule<Count> rule;
  std::array<long double, Count> roots{};
  for (std::size_t i = 0; i < Count; ++i) {
    long double x = i == 0 ? 1.0L + 1e-3L : roots[i - 1] - 1e-6L;
    for (int step = 0; step < 60; ++step) {
      const auto p = detail::legendre(Count, x);
      long double poles = 0;
      for (std::size_t j = 0; j < i; ++j) poles += 1 / (x - roots[j]);
      x -= p.value / (p.derivative - p.value * poles);
    }
    roots[i] = x;
    const long double slope = detail::legendre(Count, x).derivative;
    rule.nodes[i] = static_cast<double>((1 - x) / 2);
    rule.weights[i] = static_cast<double>(1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

template <std::size_t Count>
inline constexpr GaussRule<Count> gauss_rule = make_gauss_rule<Count>();

}  // namespace marrow
