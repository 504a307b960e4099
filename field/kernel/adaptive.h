// Quadrature that halves panels until two estimates agree.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "field/math/gauss_rule.h"

namespace marrow {

/// The rule of 20 nodes over one panel: visit(x, weight, sum) adds a node, Sum is zero when made.
template <class Sum, class Visit>
Sum over_panel(double begin, double length, const Visit& visit) {
  const auto& rule = gauss_rule<20>;
  Sum sum;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    visit(begin + length * rule.nodes[i], length * rule.weights[i], sum);
  return sum;
}

/// The integral of a sum over [begin, end], of which `whole` is that by one panel: Sum has += too, and agree(coarse,
/// fine, gathered) says whether the whole of a panel and its two halves are near enough, `gathered` being what others
/// have come to. For integrands with kinks at unknown places: a panel with a kink is given up after 40 halvings, 1e-12
/// of the interval, and all panels after 2000 of them, when rounding is what keeps estimates apart.
template <class Sum, class Visit, class Agree>
Sum integrate_adaptively(double begin, double end, const Sum& whole, const Visit& visit, const Agree& agree) {
  constexpr std::size_t deepest = 40, most_panels = 2000;
  struct Piece {
    double begin, length;
    Sum whole;
    std::size_t depth;
  };
  std::array<Piece, deepest + 3> open;
  open[0] = {begin, end - begin, whole, 0};
  std::size_t count = 1;
  Sum total;
  for (std::size_t panels = 0; count > 0; ++panels) {
    const Piece piece = open[--count];
    const double half = piece.length / 2;
    const Sum left = over_panel<Sum>(piece.begin, half, visit);
    const Sum right = over_panel<Sum>(piece.begin + half, half, visit);
    Sum fine = left;
    fine += right;
    if (piece.depth == deepest || panels > most_panels || agree(piece.whole, fine, total)) {
      total += fine;
      continue;
    }
    open[count++] = {piece.begin + half, half, right, piece.depth + 1};
    open[count++] = {piece.begin, half, left, piece.depth + 1};
  }
  return total;
}

}  // namespace marrow
