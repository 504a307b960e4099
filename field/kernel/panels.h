// Cuts an interval of integration into panels that Gauss-Legendre rules integrate to full precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "field/kernel/inverse_family.h"
#include "field/math/gauss_rule.h"

namespace marrow {

/// A pair of singularities re +- i im of an integrand.
struct Singularity {
  double re, im;
};

struct Panel {
  double begin, length;
  double distance;  ///< to the nearest singularity
};

/// A rule of 20 nodes errs by 2e-22 at this distance over the length, and of 12 and 8 at those below (the Bernstein
/// ellipses of segment_moments.cpp).
inline constexpr double panel_distance_20 = 0.8, panel_distance_12 = 2, panel_distance_8 = 6;

inline double distance_to(std::span<const Singularity> singularities, double begin, double end) {
  double least = std::numeric_limits<double>::infinity();
  for (const Singularity& s : singularities) {
    const double off = std::max({0.0, begin - s.re, s.re - end});
    least = std::min(least, std::sqrt(off * off + s.im * s.im));
  }
  return least;
}

/// Calls visit(Panel) for panels that cover [begin, end], each at least 0.8 times its length away from every
/// singularity and at most `longest` long, by bisection; from 0 outward where 0 is inside, so that panels may shrink
/// below the resolution of begin and end there. Gives up on a singularity of the interval itself after 100 halvings, or
/// where squares of lengths are no normal numbers any more, so that all distances are 0.
template <class Visit>
void for_each_panel(double begin, double end, std::span<const Singularity> singularities, double longest,
                    const Visit& visit) {
  constexpr std::size_t deepest = 100;
  constexpr double shortest = 0x1p-511;
  struct Piece {
    double begin, end;
    std::size_t depth;
  };
  std::array<Piece, deepest + 3> open;
  std::size_t count = 0;
  const auto push = [&](double a, double b, std::size_t depth) {
    if (b > a) open[count++] = {a, b, depth};
  };
  const double middle = std::clamp(0.0, begin, end);
  push(middle, end, 0);
  push(begin, middle, 0);
  while (count > 0) {
    const auto [a, b, depth] = open[--count];
    const double length = b - a, distance = distance_to(singularities, a, b);
    if (depth == deepest || length <= shortest || (length <= longest && panel_distance_20 * length <= distance)) {
      visit(Panel{a, length, distance});
    } else {
      const double half = a + length / 2;
      push(half, b, depth + 1);
      push(a, half, depth + 1);
    }
  }
}

/// Calls visit(x, weight) at the nodes of the shortest rule that integrates polynomials of the degree, up to 23, over
/// [0, length].
template <class Visit>
void for_each_polynomial_node(double length, int degree, const Visit& visit) {
  const auto with = [&](const auto& rule) {
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) visit(length * rule.nodes[i], length * rule.weights[i]);
  };
  if (degree <= 5) with(gauss_rule<3>);
  else if (degree <= 7) with(gauss_rule<4>);
  else if (degree <= 11) with(gauss_rule<6>);
  else if (degree <= 15) with(gauss_rule<8>);
  else with(gauss_rule<12>);
}

/// Calls visit(x, weight) at the nodes of the shortest rule that holds for an integrand with a polynomial factor of
/// the given degree.
template <class Visit>
void for_each_node(const Panel& panel, int polynomial_degree, const Visit& visit) {
  const auto with = [&](const auto& rule) {
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      visit(panel.begin + panel.length * rule.nodes[i], panel.length * rule.weights[i]);
  };
  if (panel.distance >= panel_distance_8 * panel.length && polynomial_degree < 8) with(gauss_rule<8>);
  else if (panel.distance >= panel_distance_12 * panel.length && polynomial_degree < 12) with(gauss_rule<12>);
  else with(gauss_rule<20>);
}

/// Calls visit(angle, weight) at nodes over [first, last], within a right angle of 0, for powers of the cosine with a
/// pole besides. Up to the 16th power a rule of 20 nodes does for a right angle (6e-16), up to the 24th for a length of
/// 1.
template <class Visit>
void for_each_angle(double first, double last, const Singularity& pole, int power, const Visit& visit) {
  const double longest = power <= 16 ? 1.6 : 1;
  for_each_panel(first, last, {&pole, 1}, longest,
                 [&](const Panel& panel) { for_each_node(panel, max_kernel_degree, visit); });
}

}  // namespace marrow
