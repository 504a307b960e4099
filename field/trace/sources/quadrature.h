// Gauss-Legendre rules of any small size, and how far off they can be for a piece of skeleton.
#pragma once

#include <array>
#include <span>

#include "field/trace/kernels/block_kernels.h"
#include "field/trace/sources/rule_errors.h"

namespace marrow {

inline constexpr int max_gauss_nodes = RuleErrors::most_nodes;
static_assert(max_gauss_nodes == most_rule_nodes);

/// Nodes in (0, 1); the weights sum to 1.
struct GaussNodes {
  std::span<const double> positions, weights;
};

/// The rule with `count` nodes, 1 <= count <= max_gauss_nodes.
GaussNodes gauss_legendre(int count);

/// All of them, as kernels read them.
const NodeTable& node_table();

/// Bounds the error of Gauss-Legendre quadrature for the integrals of one straight piece,
///   f = 1/N int tau^(n-1) d^-n ds   and   grad_S f = -n/N int tau^n (p-q) d^-(n+2) ds,
/// at any p whose distance from the piece is at least `distance`.
///
/// Derivation. The m-node rule on a length L has the error c_m L^(2m+1) |F^(2m)(xi)| / (2m)! with
/// c_m = (m!)^4 / ((2m+1) ((2m)!)^2) [Abramowitz and Stegun 25.4.30]. The k-th derivative of d^-n along a line is, over
/// k!, at most binom(n+k-1, k) d^-(n+k), because Gegenbauer polynomials are largest at 1; that of the
/// vector (p-q) d^-(n+2) at most binom(n+k, k) d^-(n+1+k). Leibniz' rule with the linear radius gives at most the
/// factor (1 + |slope| d / tau)^(exponent of tau), and with a linear weight beside it (1 + |lean| d / L) more. Close to
/// a piece, from half its length on, that grows with m, though the rule converges: RuleErrors tell the error itself,
/// and the smaller of the two counts.
class GaussError {
 public:
  explicit GaussError(int degree);
  struct Bound {
    double field;     ///< of f
    double gradient;  ///< of |grad_S f|
  };
  /// What of a piece the error goes by.
  struct Stretch {
    double mass;            ///< L tau_max^(n-1) / N, times the largest weight
    double largest_radius;  ///< tau_max
    double slope;           ///< |d tau / ds|
    double length;          ///< L
    double lean = 0;        ///< of a linear weight, the difference of both ends over the larger one
  };
  Bound bound(int nodes, const Stretch&, double distance) const;
  /// What bound() multiplies with powers of lengths.
  Bound constants(int nodes) const {
    return {field_[static_cast<std::size_t>(nodes)], gradient_[static_cast<std::size_t>(nodes)]};
  }
  struct Rule {
    int nodes = 1;
    Bound error{};
    bool within = true;  ///< false: even this, the largest rule, is not good enough
  };
  /// The smallest rule whose error is within `allowed`, else the largest.
  Rule smallest_rule(const Stretch&, double distance, Bound allowed) const;

 private:
  class Rules;

  int degree_;
  const RuleErrors* close_;
  std::array<double, max_gauss_nodes + 1> field_{}, gradient_{};  // c_m binom, for each m
};

}  // namespace marrow
