#include "field/trace/near_far.h"

#include <algorithm>
#include <cmath>

#include "field/math/elementary.h"
#include "field/trace/block_kernels.h"
#include "field/trace/source_groups.h"

namespace marrow {

NearFar::NearFar(int degree, ErrorBudget budget, const BlockKernels& kernels)
    : degree_(degree), budget_(budget), kernels_(kernels), quadrature_(degree) {
  for (int i = 0; i <= table_size; ++i) {
    const double q = largest_ratio * i / table_size;
    curve_.push_back({taylor_remainder(degree, 4, q), taylor_remainder(degree + 1, 4, q)});
    point_.push_back({taylor_remainder(degree - 1, 4, q), taylor_remainder(degree, 4, q)});
  }
}

// The remainders grow with q, so the next entry of the table is an upper bound.
NearFar::Remainders NearFar::remainders(bool point, double q) const {
  const auto i = static_cast<std::size_t>(q / largest_ratio * table_size) + 1;
  return (point ? point_ : curve_)[std::min<std::size_t>(i, table_size)];
}

bool NearFar::is_far(const Piece& piece, double distance, double cube_radius, FarField& far) const {
  if (cube_radius > largest_ratio * distance) return false;
  const Remainders r = remainders(piece.is_point(), cube_radius / distance);
  const int exponent = degree_ - (piece.is_point() ? 1 : 0);
  const double field = piece.mass / integer_power(distance, exponent);
  const double field_error = field * r.field;
  const double gradient_error = field * exponent * piece.radius / distance * r.gradient;
  if (field_error > budget_.field || gradient_error > budget_.gradient) return false;
  far.f_error += field_error;
  far.gradient_error += gradient_error;
  return true;
}

NearFar::Rule NearFar::rule_for(const Piece& piece, double distance, double share) const {
  if (piece.is_point()) return {.nodes = 1, .error = {}};
  const double slope = std::fabs(piece.radius_to - piece.radius_from) / piece.length;
  return quadrature_.smallest_rule(piece.mass, piece.radius, slope, piece.length, distance,
                                   {share * budget_.field, share * budget_.gradient});
}

void add_nodes(const Piece& piece, int count, const Vec3d& center, double half, int degree, SourceGroups& out) {
  const double scale = 1 / half;
  if (piece.is_point()) {
    const double radius = piece.radius * scale;
    out.add((piece.from - center) * scale, integer_power(radius, degree - 1), radius);
    return;
  }
  const GaussNodes rule = gauss_legendre(count);
  const double unit = piece.mass / integer_power(piece.radius, degree - 1) * scale;  // L / N in cube units
  for (std::size_t k = 0; k < rule.positions.size(); ++k) {
    const double s = rule.positions[k];
    const double radius = (piece.radius_from + (piece.radius_to - piece.radius_from) * s) * scale;
    out.add((lerp(piece.from, piece.to, s) - center) * scale,
            rule.weights[k] * unit * integer_power(radius, degree - 1), radius);
  }
}

// The far sources of one cube, inverted: at y = r / |r|^2 with the field f_i that each has at the centre, so that
// moments are sums of f_i y^(tensor k) |y|^(2j), in which nothing can overflow, however far the source.
struct NearFar::FarLists {
  Vec3d center;
  double half;
  FarField& far;
  SourceGroups curves{}, points{};

  double cube_radius() const { return half * std::sqrt(3.0); }
  // q, w and tau in world units.
  void add(bool point, int exponent, const Vec3d& q, double w, double tau) {
    const Vec3d r = q - center;
    const double inverse2 = 1 / length_squared(r);
    const double field =
        w * integer_power(exponent % 2 ? std::sqrt(inverse2) : inverse2, exponent % 2 ? exponent : exponent / 2);
    (point ? points : curves).add(r * (inverse2 * half), field, tau / half);
  }
};

// Sums in float: their error, a millionth of what they add, counts.
void NearFar::fold(const FarLists& lists) const {
  for (const bool point : {false, true}) {
    const SourceGroups& sources = point ? lists.points : lists.curves;
    if (sources.group_count() == 0) continue;
    FarField& far = lists.far;
    Moments f, potential;
    kernels_.far_moments(sources.data(), sources.group_count(), f.data(), potential.data());
    const double before = far.f[0];
    add_moments(f, potential, degree_ - (point ? 1 : 0), far);
    constexpr double rounding = 1e-6;
    far.f_error += rounding * (far.f[0] - before);
    far.gradient_error += rounding * (far.f[0] - before);
  }
}

bool NearFar::add_if_far(const Piece& piece, FarLists& lists) const {
  constexpr double quadrature_share = 0.25;
  const double d = distance(piece, lists.center);
  if (!is_far(piece, d, lists.cube_radius(), lists.far)) return false;
  const Rule rule = rule_for(piece, d - lists.cube_radius(), quadrature_share);
  lists.far.f_error += rule.error.field;
  lists.far.gradient_error += rule.error.gradient;
  if (piece.is_point()) {
    lists.add(true, degree_ - 1, piece.from, piece.mass, piece.radius);
    return true;
  }
  const GaussNodes nodes = gauss_legendre(rule.nodes);
  const double unit = piece.mass / integer_power(piece.radius, degree_ - 1);
  for (std::size_t k = 0; k < nodes.positions.size(); ++k) {
    const double s = nodes.positions[k], tau = piece.radius_from + (piece.radius_to - piece.radius_from) * s;
    lists.add(false, degree_, lerp(piece.from, piece.to, s), nodes.weights[k] * unit * integer_power(tau, degree_ - 1),
              tau);
  }
  return true;
}

// All of a group at its centre of mass c. With K = d^-m the field is sum w K(q), and sum w (q - c) = 0, so that
//   |f - W K(c)| <= 1/2 sum w |q-c|^2 max |grad^2 K|,   |grad^2 K| <= m (m+1) D^-(m+2),
// D the least distance between the cube and the ball of the group. The gradient of the potential sum w tau K loses
// |sum w tau (q - c)| m (m+1) D^-(m+2) and 1/2 sum w tau |q-c|^2 m (m+1) (m+2) D^-(m+3). To this comes the remainder B5
// of a point source at c.
bool NearFar::is_far(const SourceNode& group, double distance, double cube_radius, FarField& far) const {
  const double clear = distance - cube_radius - group.radius;
  if (cube_radius > largest_ratio * distance || !(clear > 0)) return false;
  const Remainders r = remainders(group.is_point, cube_radius / distance);
  const double m = group.exponent;
  const double bend = m * (m + 1) / integer_power(clear, group.exponent + 2);
  const double raised = 1 / integer_power(distance, group.exponent);
  const double field_error = group.mass * raised * r.field + 0.5 * group.spread * bend;
  if (field_error > budget_.field) return false;
  const double gradient_error = group.tau_mass * raised * m / distance * r.gradient +
                                bend * (length(group.tau_shift) + 0.5 * (m + 2) * group.tau_spread / clear);
  if (gradient_error > budget_.gradient) return false;
  far.f_error += field_error;
  far.gradient_error += gradient_error;
  return true;
}

bool NearFar::add_if_far(const SourceNode& group, FarLists& lists) const {
  if (!is_far(group, length(group.center - lists.center), lists.cube_radius(), lists.far)) return false;
  lists.add(group.is_point, group.exponent, group.center, group.mass, group.tau_mass / group.mass);
  return true;
}

std::vector<PieceIndex> NearFar::split(std::span<const Piece> pieces, std::span<const PieceIndex> candidates,
                                       const Vec3d& center, double half, FarField& far) const {
  std::vector<PieceIndex> near;
  near.reserve(candidates.size());
  FarLists lists{center, half, far};
  for (const PieceIndex i : candidates)
    if (!add_if_far(pieces[i], lists)) near.push_back(i);
  fold(lists);
  return near;
}

std::vector<SourceRef> NearFar::split(const SourceTree& tree, std::span<const SourceRef> candidates,
                                      const Vec3d& center, double half, double keep, FarField& far) const {
  std::vector<SourceRef> near, open(candidates.rbegin(), candidates.rend());
  FarLists lists{center, half, far};
  while (!open.empty()) {
    const SourceRef here = open.back();
    open.pop_back();
    if (here.is_piece()) {
      if (!add_if_far(tree.piece(here.index()), lists)) near.push_back(here);
      continue;
    }
    const SourceNode& node = tree.node(here.index());
    if (add_if_far(node, lists)) continue;
    if (node.radius <= keep * half) {
      near.push_back(here);
    } else if (node.is_leaf()) {
      for (std::uint32_t i = node.end; i-- > node.begin;) open.push_back(SourceRef::piece(i));
    } else {
      open.push_back(SourceRef::node(node.right));
      open.push_back(SourceRef::node(here.index() + 1));
    }
  }
  fold(lists);
  return near;
}

}  // namespace marrow
