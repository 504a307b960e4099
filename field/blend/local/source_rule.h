// How many nodes a Gauss-Legendre rule needs to stand for a piece of skeleton.
#pragma once

#include <optional>

namespace marrow {

/// What a rule runs along: a straight line or an arc, over a parameter s in [-1, 1], of the integrand
///   w tau^power D^-exponent   and   w tau^(power+1) (p - q) D^-(exponent+2).
struct RulePiece {
  double half_length = 0;
  double half_angle = 0;   ///< of an arc; 0: straight
  double half_lift = 0;    ///< by which the lift of its sources varies to either side
  double radius = 1;       ///< tau in the middle of its range
  double half_radius = 0;  ///< by which tau varies to either side
  int power = 3, exponent = 4;
  bool widens = false;  ///< a factor that grows from 0 to twice its mean (lines through a corner of a triangle)
};

inline constexpr int most_rule_nodes = 16;

/// The number of nodes that is certainly right to `relative` times mass tau_max^power d^-exponent, and, of the second
/// integrand, times that times exponent tau_max / d, for all p whose distance D from the piece is at least
/// `distance` = d. Nothing where that takes more than most_rule_nodes: cut the piece.
///
/// Derivation. On a Bernstein ellipse with the sum of half axes rho, an integrand that is analytic and at most M there
/// differs from its Chebyshev series up to degree 2k - 1 by at most 2 M rho^(1-2k) / (rho - 1), and a rule of k nodes
/// is exact for that: its mean is off by twice as much, 4 M rho^-2k / (1 - 1/rho). At s with the imaginary part b the
/// source moves by a vector with the imaginary part i h b (h b of an arc becoming R sinh, with a real shift of
/// R (cosh - 1)), so |D^2| >= (real distance)^2 - (imaginary part)^2.   [Trefethen, Approximation Theory, 8.2, 19.3]
std::optional<int> rule_nodes(const RulePiece&, double distance, double relative);

}  // namespace marrow
