#include "field/trace/outside_bound.h"

#include <array>
#include <cmath>

#include "field/math/elementary.h"
#include "field/trace/sources/quadrature.h"

namespace marrow {
namespace {

// What sums are raised by. C grows nearly as f does: where both sums are raised by so much and C is still below 1, it
// was below 1 - clearly_below, whatever the angle (some 0.992).
constexpr double raised = 1.01;

}  // namespace

// f and grad_S f as summed, and what they may be off.
struct OutsideBound::Sums {
  double field = 0, field_error = 0, gradient_error = 0;
  Vec3d gradient;

  // All of a source w with the radius tau, r away: w d^-m, and -m w tau r d^-(m+2).
  void add(double w, double tau, const Vec3d& r, int m) {
    const double inverse2 = 1 / length_squared(r);
    const double f = w * integer_power(m % 2 ? std::sqrt(inverse2) : inverse2, m % 2 ? m : m / 2);
    field += f;
    gradient += r * (-m * f * tau * inverse2);
  }
};

// As NearFar::counts_as_far(), of a cube that is a point.
bool OutsideBound::add_group(const SourceNode& group, const Vec3d& r, Sums& sums) const {
  const double clear = length(r) - group.radius, m = group.exponent;
  if (!(clear > 0)) return false;
  const double bend = m * (m + 1) / integer_power(clear, group.exponent + 2);
  const double field_error = 0.5 * group.spread * bend;
  if (field_error > rules_.budget().field) return false;
  const double gradient_error = bend * (length(group.tau_shift) + 0.5 * (m + 2) * group.tau_spread / clear);
  if (gradient_error > rules_.budget().gradient) return false;
  sums.field_error += field_error;
  sums.gradient_error += gradient_error;
  sums.add(group.mass, group.tau_mass / group.mass, r, group.exponent);
  return true;
}

// Whether there is a rule that is good enough.
bool OutsideBound::add_piece(const Piece& piece, const Vec3d& p, Sums& sums) const {
  if (piece.is_point()) {
    sums.add(piece.mass, piece.radius, p - piece.from, rules_.degree() - 1);
    return true;
  }
  const NearFar::Rule rule = rules_.rule_for(piece, distance(piece, p), 1);
  if (!rule.within) return false;
  sums.field_error += rule.error.field;
  sums.gradient_error += rule.error.gradient;
  const GaussNodes nodes = gauss_legendre(rule.nodes);
  for (std::size_t k = 0; k < nodes.positions.size(); ++k) {
    const double s = nodes.positions[k], tau = piece.radius_from + (piece.radius_to - piece.radius_from) * s;
    const double w = nodes.weights[k] * piece.mass * integer_power(tau / piece.radius, rules_.degree() - 1);
    sums.add(w, tau, p - lerp(piece.from, piece.to, s), rules_.degree());
  }
  return true;
}

bool OutsideBound::holds(const Vec3d& p) const {
  // The halves of a node wait while its parts are looked at: one for each level, and 2^31 pieces have fewer.
  std::array<std::uint32_t, 64> open;
  Sums sums;
  for (const SourceRef root : tree_.roots()) {
    std::size_t count = 0;
    open[count++] = root.index();
    while (count > 0) {
      const std::uint32_t index = open[--count];
      const SourceNode& node = tree_.node(index);
      if (add_group(node, p - node.center, sums)) continue;
      if (node.is_leaf()) {
        for (const Piece& piece : tree_.pieces().subspan(node.begin, node.end - node.begin))
          if (!add_piece(piece, p, sums)) return false;
      } else {
        open[count++] = node.right;
        open[count++] = index + 1;
      }
      if (sums.field - sums.field_error > iso_.critical_field()) return false;
    }
  }
  return iso_.outside(0, raised * (sums.field + sums.field_error),
                      raised * (length(sums.gradient) + sums.gradient_error));
}

}  // namespace marrow
