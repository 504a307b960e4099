#include "field/trace/side_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "field/math/elementary.h"
#include "field/trace/sources/quadrature.h"

namespace marrow {
namespace {

// What sums are raised by, or lowered. C grows nearly as f does: where both sums are raised by so much and C is still
// below 1, it was below 1 - clearly, whatever the angle (some 0.992); so it is to the other side.
constexpr double raised = 1.01;
constexpr int most_halvings = 4;  // of a piece of which no rule is good enough
// By how much more than the rules allow groups and pieces may be off, first, which tells the side of most places.
constexpr double rough = 64, close = 1;

}  // namespace

// f and grad_S f as summed, and what they may be off.
struct SideBound::Sums {
  double may_be_off;  // times what the rules allow
  double field = 0, field_error = 0, gradient_error = 0;
  Vec3d gradient{};

  // All of a source w with the radius tau, r away: w d^-m, and -m w tau r d^-(m+2).
  void add(double w, double tau, const Vec3d& r, int m) {
    const double inverse2 = 1 / length_squared(r);
    const double f = w * integer_power(m % 2 ? std::sqrt(inverse2) : inverse2, m % 2 ? m : m / 2);
    field += f;
    gradient += r * (-m * f * tau * inverse2);
  }
};

// As NearFar::counts_as_far(), of a cube that is a point.
bool SideBound::add_group(const SourceNode& group, const Vec3d& r, Sums& sums) const {
  const double clear = length(r) - group.radius, m = group.exponent;
  if (!(clear > 0)) return false;
  const double bend = m * (m + 1) / integer_power(clear, group.exponent + 2);
  const double field_error = 0.5 * group.spread * bend;
  if (field_error > sums.may_be_off * rules_.budget().field) return false;
  const double gradient_error = bend * (length(group.tau_shift) + 0.5 * (m + 2) * group.tau_spread / clear);
  if (gradient_error > sums.may_be_off * rules_.budget().gradient) return false;
  sums.field_error += field_error;
  sums.gradient_error += gradient_error;
  sums.add(group.mass, group.tau_mass / group.mass, r, group.exponent);
  return true;
}

namespace {

// The half of a piece of a curve that begins at a share of it.
Piece half_of(const Piece& whole, double begin, int degree) {
  const auto radius_at = [&](double s) { return whole.radius_from + (whole.radius_to - whole.radius_from) * s; };
  Piece half = whole;
  half.from = lerp(whole.from, whole.to, begin);
  half.to = lerp(whole.from, whole.to, begin + 0.5);
  half.radius_from = radius_at(begin);
  half.radius_to = radius_at(begin + 0.5);
  half.length = 0.5 * whole.length;
  half.radius = std::max(half.radius_from, half.radius_to);
  half.mass = 0.5 * whole.mass * integer_power(half.radius / whole.radius, degree - 1);
  return half;
}

}  // namespace

// Whether there is a rule that is good enough, for the piece or for its parts.
bool SideBound::add_piece(const Piece& piece, const Vec3d& p, int halvings, Sums& sums) const {
  const int n = rules_.degree();
  if (piece.is_point()) {
    sums.add(piece.mass, piece.radius, p - piece.from, n - 1);
    return true;
  }
  const NearFar::Rule rule = rules_.rule_for(piece, distance(piece, p), sums.may_be_off);
  if (!rule.within)
    return halvings > 0 && add_piece(half_of(piece, 0, n), p, halvings - 1, sums) &&
           add_piece(half_of(piece, 0.5, n), p, halvings - 1, sums);
  sums.field_error += rule.error.field;
  sums.gradient_error += rule.error.gradient;
  const GaussNodes nodes = gauss_legendre(rule.nodes);
  for (std::size_t k = 0; k < nodes.positions.size(); ++k) {
    const double s = nodes.positions[k], tau = piece.radius_from + (piece.radius_to - piece.radius_from) * s;
    const double w = nodes.weights[k] * piece.mass * integer_power(tau / piece.radius, n - 1);
    sums.add(w, tau, p - lerp(piece.from, piece.to, s), n);
  }
  return true;
}

bool SideBound::add_leaf(const SourceNode& leaf, const Vec3d& p, Sums& sums) const {
  for (const Piece& piece : tree_.pieces().subspan(leaf.begin, leaf.end - leaf.begin))
    if (!add_piece(piece, p, most_halvings, sums)) return false;
  return true;
}

// Whether a piece of a leaf has p inside by its own field.
bool SideBound::is_inside_alone(const SourceNode& leaf, const Vec3d& p) const {
  for (const Piece& piece : tree_.pieces().subspan(leaf.begin, leaf.end - leaf.begin))
    if (distance(piece, p) * raised < piece.inside_distance) return true;
  return false;
}

Side SideBound::side_by(const Sums& s) const {
  const double field = s.field, gradient = length(s.gradient);
  if (iso_.outside(0, raised * (field + s.field_error), raised * (gradient + s.gradient_error))) return Side::Outside;
  const bool inside =
      iso_.inside(std::max(0.0, field - s.field_error) / raised, std::max(0.0, gradient - s.gradient_error) / raised);
  return inside ? Side::Inside : Side::Unknown;
}

Side SideBound::side(const Vec3d& p) const {
  const Side side = side_by_sums(p, rough);
  return side == Side::Unknown ? side_by_sums(p, close) : side;
}

namespace {

// What comes of a group: it is taken as it is, or opened, or no other matters any more.
enum class Visit { Taken, Opened, Last };

// visit(node) of the groups of a tree, from its roots down. Returns whether it went on to the end.
template <class VisitNode>
bool visit_groups(const SourceTree& tree, const VisitNode& visit) {
  // The halves of a node wait while its parts are looked at: one for each level, and 2^31 pieces have fewer.
  std::array<std::uint32_t, 64> open;
  for (const SourceRef root : tree.roots()) {
    std::size_t count = 0;
    open[count++] = root.index();
    while (count > 0) {
      const std::uint32_t index = open[--count];
      const Visit done = visit(tree.node(index));
      if (done == Visit::Last) return false;
      if (done == Visit::Taken) continue;
      open[count++] = tree.node(index).right;
      open[count++] = index + 1;
    }
  }
  return true;
}

}  // namespace

Side SideBound::side_by_sums(const Vec3d& p, double may_be_off) const {
  Sums sums{.may_be_off = may_be_off};
  Side told = Side::Unknown;
  const bool all_taken = visit_groups(tree_, [&](const SourceNode& node) {
    if (!add_group(node, p - node.center, sums)) {
      if (!node.is_leaf()) return Visit::Opened;
      if (is_inside_alone(node, p)) told = Side::Inside;
      if (told == Side::Inside || !add_leaf(node, p, sums)) return Visit::Last;
    }
    if (sums.field - sums.field_error <= raised * iso_.critical_field()) return Visit::Taken;
    told = Side::Inside;
    return Visit::Last;
  });
  return all_taken ? side_by(sums) : told;
}

// Around a box, with what f and |grad_S f| come to in it at most.
struct SideBound::Ball {
  Vec3d center;
  double radius;
  double field = 0, gradient = 0;
  bool holds_inside = false;  // all of it is inside by a piece alone

  // Sources w of radii tau, nowhere nearer than that.
  void add(double w, double w_tau, double nearest, int m) {
    const double f = integer_power(1 / nearest, m);
    field += w * f;
    gradient += m * w_tau * f / nearest;
  }
};

// False: nothing more needs to be added.
bool SideBound::add_leaf(const SourceNode& leaf, Ball& ball) const {
  for (const Piece& piece : tree_.pieces().subspan(leaf.begin, leaf.end - leaf.begin)) {
    const double away = distance(piece, ball.center);
    ball.holds_inside = (away + ball.radius) * raised < piece.inside_distance;
    if (ball.holds_inside || !(away > ball.radius)) return false;
    ball.add(piece.mass, piece.mass * piece.radius, away - ball.radius, leaf.exponent);
  }
  return true;
}

Side SideBound::side(const Box3& box) const {
  constexpr double far = 2;  // times what they reach groups are taken as they are
  Ball ball{.center = box.center(), .radius = 0.5 * length(box.size())};
  const bool all_taken = visit_groups(tree_, [&](const SourceNode& node) {
    const double away = length(ball.center - node.center), reach = node.radius + ball.radius;
    if (away > far * reach) ball.add(node.mass, node.tau_mass, away - reach, node.exponent);
    else if (!node.is_leaf()) return Visit::Opened;
    else if (!add_leaf(node, ball)) return Visit::Last;
    return ball.field > iso_.critical_field() ? Visit::Last : Visit::Taken;
  });
  if (!all_taken) return ball.holds_inside ? Side::Inside : Side::Unknown;
  return iso_.outside(0, raised * ball.field, raised * ball.gradient) ? Side::Outside : Side::Unknown;
}

}  // namespace marrow
