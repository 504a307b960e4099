// Quadrature that halves panels until two estimates agree.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "field/math/gauss_rule.h"

namespace marrow {

/// The integral of a sum over [begin, end]: visit(x, weight, sum) adds a node, Sum is zero when made and has += and a
/// value, and agree(coarse, fine, all) says whether the whole of a panel and its two halves are near enough, `all`
/// being the larger of a first estimate of the integral and what has been gathered. Starts with two panels. For
/// integrands with kinks at unknown places: a panel with a kink is given up after 40 halvings, 1e-12 of the interval,
/// and all panels after 2000 of them, when rounding is what keeps estimates apart.
template <class Sum, class Visit, class Agree>
Sum integrate_adaptively(double begin, double end, const Visit& visit, const Agree& agree) {
  constexpr std::size_t first_panels = 2, deepest = 40, most_panels = 2000;
  struct Piece {
    double begin, length;
    Sum whole;
    std::size_t depth;
  };
  const auto& rule = gauss_rule<20>;
  const auto over = [&](double a, double length) {
    Sum sum;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      visit(a + length * rule.nodes[i], length * rule.weights[i], sum);
    return sum;
  };
  std::array<Piece, first_panels + deepest + 2> open;
  std::size_t count = 0;
  const double step = (end - begin) / first_panels;
  Sum total, estimate;
  for (std::size_t i = first_panels; i-- > 0;) {
    const double a = begin + step * static_cast<double>(i);
    open[count++] = {a, step, over(a, step), 0};
    estimate += open[count - 1].whole;
  }
  for (std::size_t panels = 0; count > 0; ++panels) {
    const Piece piece = open[--count];
    const double half = piece.length / 2;
    const Sum left = over(piece.begin, half), right = over(piece.begin + half, half);
    Sum fine = left;
    fine += right;
    if (piece.depth == deepest || panels > most_panels ||
        agree(piece.whole, fine, estimate.value > total.value ? estimate : total)) {
      total += fine;
      continue;
    }
    open[count++] = {piece.begin + half, half, right, piece.depth + 1};
    open[count++] = {piece.begin, half, left, piece.depth + 1};
  }
  return total;
}

}  // namespace marrow
