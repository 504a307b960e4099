#include "field/trace/sources/near_far.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "field/base/ask_for.h"
#include "field/math/elementary.h"
#include "field/math/taylor_remainder.h"
#include "field/trace/kernels/cube_remainder.h"
#include "field/trace/sources/near_groups.h"
#include "field/trace/sources/source_groups.h"

namespace marrow {
namespace {

double cube_share(int far_degree, const Vec3d& place) {
  const Vec3d sizes = abs(place);
  const double spread = (sizes.x + sizes.y + sizes.z) / length(place);
  const auto& share = far_degree == low_far_degree    ? CubeRemainder<low_far_degree>::share
                      : far_degree == high_far_degree ? CubeRemainder<high_far_degree>::share
                                                      : CubeRemainder<highest_far_degree>::share;
  for (int i = 0; i < remainder_steps; ++i)
    if (spread <= static_cast<double>(remainder_spread[i])) return static_cast<double>(share[i]);
  return 1;
}

}  // namespace

NearFar::NearFar(int degree, ErrorBudget budget, const BlockKernels& kernels, int far_degree)
    : degree_(degree),
      far_degree_(far_degree),
      budget_(budget),
      kernels_(kernels),
      quadrature_(degree),
      curve_moments_(degree, far_degree),
      point_moments_(degree - 1, far_degree) {
  for (int i = 0; i <= table_size; ++i) {
    const double q = largest_ratio * i / table_size;
    curve_.push_back({taylor_remainder(degree, far_degree, q), taylor_remainder(degree + 1, far_degree, q)});
    point_.push_back({taylor_remainder(degree - 1, far_degree, q), taylor_remainder(degree, far_degree, q)});
  }
}

// The remainders grow with q, so the next entry of the table is an upper bound.
NearFar::Remainders NearFar::remainders(bool point, double q) const {
  const auto i = static_cast<std::size_t>(q / largest_ratio * table_size) + 1;
  return (point ? point_ : curve_)[std::min<std::size_t>(i, table_size)];
}

NearFar::Rule NearFar::rule_for(const Piece& piece, double distance, double share) const {
  if (piece.is_point()) return {.nodes = 1, .error = {}};
  const double slope = std::fabs(piece.radius_to - piece.radius_from) / piece.length;
  return quadrature_.smallest_rule(
      {.mass = piece.mass, .largest_radius = piece.radius, .slope = slope, .length = piece.length, .lean = piece.lean},
      distance, {share * budget_.field, share * budget_.gradient});
}

void add_nodes(const Piece& piece, int count, const Vec3d& center, double half, int degree, SourceGroups& out) {
  const double scale = 1 / half;
  if (piece.is_point()) {
    const double radius = piece.radius * scale;
    out.add((piece.from - center) * scale, piece.factor, radius);
    return;
  }
  const GaussNodes rule = gauss_legendre(count);
  const double unit = piece.mass / integer_power(piece.radius, degree - 1) * scale;  // L / N in cube units
  for (std::size_t k = 0; k < rule.positions.size(); ++k) {
    const double s = rule.positions[k];
    const double radius = (piece.radius_from + (piece.radius_to - piece.radius_from) * s) * scale;
    out.add((lerp(piece.from, piece.to, s) - center) * scale, rule.weights[k] * unit / radius * piece.weight_at(s),
            radius);
  }
}

// The far groups of one cube, inverted: at y = r / |r|^2 with the field f_i that each has at the centre, so that
// moments are sums of f_i y^(tensor k) |y|^(2j), in which nothing can overflow, however far the source.
struct NearFar::FarGroups {
  Vec3d center;
  double half;
  FarField& far;
  SourceGroups curves{}, points{};

  void add(const SourceNode& group) {
    const Vec3d r = group.center - center;
    const double inverse2 = 1 / length_squared(r);
    const int m = group.exponent;
    const double field = group.mass * integer_power(m % 2 ? std::sqrt(inverse2) : inverse2, m % 2 ? m : m / 2);
    (group.is_point ? points : curves).add(r * (inverse2 * half), field, group.tau_mass / group.mass / half);
  }
};

// Sums in float: their error counts.
void NearFar::fold(const FarGroups& groups) const {
  for (const bool point : {false, true}) {
    const SourceGroups& sources = point ? groups.points : groups.curves;
    if (sources.group_count() == 0) continue;
    FarField& far = groups.far;
    std::array<float, most_far_moments> f, potential;
    kernels_.far_moments(sources.data(), sources.group_count(), far_degree_, f.data(), potential.data());
    (point ? point_moments_ : curve_moments_).add(f.data(), potential.data(), far);
    const double first = length({potential[1], potential[2], potential[3]});
    far.f_error += sum_rounding() * static_cast<double>(f[0]);
    far.gradient_error += sum_rounding() * 4 * degree_ * std::max(first, static_cast<double>(f[0]));
  }
}

// Coordinates relative to the cube are off by some 1e-7 of the distance of their source, whose field falls with the
// power n of that, the gradient with n + 1.
double NearFar::sum_rounding() const { return 4e-7 * (degree_ + 2); }

// All of a group at its centre of mass c. With K = d^-m the field is sum w K(q), and sum w (q - c) = 0, so that
//   |f - W K(c)| <= 1/2 sum w |q-c|^2 max |grad^2 K|,   |grad^2 K| <= m (m+1) D^-(m+2),
// D the least distance between the cube and the ball of the group. The gradient of the potential sum w tau K loses
// |sum w tau (q - c)| m (m+1) D^-(m+2) and 1/2 sum w tau |q-c|^2 m (m+1) (m+2) D^-(m+3). To this comes the remainder B5
// of a point source at c.
bool NearFar::counts_as_far(const SourceNode& group, const Vec3d& place, double cube_radius, FarField& far) const {
  const double distance = length(place), clear = distance - cube_radius - group.radius;
  if (cube_radius > largest_ratio * distance || !(clear > 0)) return false;
  const Remainders r = remainders(group.is_point, cube_radius / distance).times(cube_share(far_degree_, place));
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

// A near group whose largest field in the cube is within the budget.
bool NearFar::counts_as_slight(const SourceNode& group, double distance, double cube_radius, FarField& far) const {
  const double clear = distance - cube_radius - group.radius;
  if (!(clear > 0)) return false;
  const double raised = 1 / integer_power(clear, group.exponent);
  const double field = group.mass * raised, gradient = group.exponent * group.tau_mass * raised / clear;
  if (field > budget_.field || gradient > budget_.gradient) return false;
  far.f_error += field;
  far.gradient_error += gradient;
  return true;
}

bool NearFar::add_if_far(const SourceNode& group, FarGroups& groups) const {
  if (!counts_as_far(group, group.center - groups.center, groups.half * std::sqrt(3.0), groups.far)) return false;
  groups.add(group);
  return true;
}

FarQuery NearFar::query(bool points, Slight slight, bool some_lean) const {
  const int m = degree_ - (points ? 1 : 0);
  // binom(m + P, P + 1), exact in double
  const auto first_neglected = [this](int exponent) {
    double binomial = 1;
    for (int i = 0; i <= far_degree_; ++i) binomial = binomial * (exponent + i) / (i + 1);
    return static_cast<float>(binomial);
  };
  FarQuery q{.center = {0, 0, 0},
             .radius = 1.732052F,  // sqrt(3), rounded up
             .half = 1,
             .exponent = m,
             .points = points,
             .some_lean = some_lean,
             .field_budget = static_cast<float>(budget_.field),
             .gradient_budget = static_cast<float>(budget_.gradient),
             .far_degree = far_degree_,
             .most_nodes = far_degree_ == low_far_degree ? 3 : most_far_nodes,
             .field_series = first_neglected(m),
             .gradient_series = first_neglected(m + 1)};
  if (slight == Slight::LeftOut) {
    q.slight_field = q.field_budget;
    q.slight_gradient = q.gradient_budget;
  }
  for (int nodes = 1; nodes <= q.most_nodes; ++nodes) {
    const GaussError::Bound c = quadrature_.constants(nodes);
    q.field_rule[nodes] = static_cast<float>(c.field);
    q.gradient_rule[nodes] = static_cast<float>(c.gradient);
  }
  return q;
}

void NearFar::add_sums(const FarSums& sums, bool points, FarField& far) const {
  (points ? point_moments_ : curve_moments_).add(sums.f, sums.potential, far);
  far.f_error += static_cast<double>(sums.f_error) + sum_rounding() * static_cast<double>(sums.field);
  far.gradient_error += static_cast<double>(sums.g_error) + sum_rounding() * static_cast<double>(sums.gradient);
}

std::vector<PieceIndex> NearFar::split(std::span<const Piece> pieces, std::span<const PieceIndex> candidates,
                                       const Vec3d& center, double half, FarField& far, Slight slight) const {
  std::vector<PieceIndex> near;
  for (const bool points : {false, true}) {
    const NearGroups groups(pieces, candidates, points, center, half);
    if (groups.count() == 0) continue;
    std::vector<unsigned short> near_lanes(static_cast<std::size_t>(groups.count()));
    FarSums sums;
    kernels_.far_split(groups.data(), groups.count(), query(points, slight, groups.some_lean()), near_lanes.data(),
                       sums);
    add_sums(sums, points, far);
    std::size_t lane = 0;
    for (const PieceIndex i : candidates) {
      if (pieces[i].is_point() != points) continue;
      if (near_lanes[lane / lanes] >> lane % lanes & 1) near.push_back(i);
      ++lane;
    }
  }
  return near;
}

std::vector<SourceRef> NearFar::split(const SourceTree& tree, std::span<const SourceRef> candidates,
                                      const Vec3d& center, double half, double keep, FarField& far) const {
  std::vector<SourceRef> near, open(candidates.rbegin(), candidates.rend());
  std::vector<PieceIndex> pieces;
  FarGroups groups{center, half, far};
  const Slight slight = keep == open_all ? Slight::LeftOut : Slight::Kept;
  constexpr std::size_t ahead = 8;  // nodes of large trees are in no cache
  while (!open.empty()) {
    const SourceRef here = open.back();
    open.pop_back();
    if (open.size() >= ahead)
      if (const SourceRef soon = open[open.size() - ahead]; !soon.is_piece())
        ask_for_lines<2>(&tree.node(soon.index()));
    if (here.is_piece()) {
      pieces.push_back(here.index());
      continue;
    }
    const SourceNode& node = tree.node(here.index());
    if (add_if_far(node, groups)) continue;
    if (slight == Slight::LeftOut && counts_as_slight(node, length(node.center - center), half * std::sqrt(3.0), far))
      continue;
    if (node.radius <= keep * half) {
      near.push_back(here);
    } else if (node.is_leaf()) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) pieces.push_back(i);
    } else {
      open.push_back(SourceRef::node(node.right));
      open.push_back(SourceRef::node(here.index() + 1));
    }
  }
  fold(groups);
  const std::vector<PieceIndex> near_pieces = split(tree.pieces(), pieces, center, half, far, slight);
  near.reserve(near.size() + near_pieces.size());  // lists are kept
  for (const PieceIndex i : near_pieces) near.push_back(SourceRef::piece(i));
  return near;
}

Surroundings refined(const NearFar& precision, const SourceTree& sources, const KeptSurroundings* parent, int octant,
                     const Vec3d& center, double half, double keep) {
  Surroundings s;
  if (parent != nullptr) s.far = parent->far.whole().of_child(octant);
  s.near = precision.split(sources, parent != nullptr ? parent->near : sources.roots(), center, half, keep, s.far);
  return s;
}

}  // namespace marrow
