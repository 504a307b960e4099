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

// Sums in float: their error, a millionth of what they add, counts.
void NearFar::fold(const SourceGroups& sources, int exponent, FarField& far) const {
  if (sources.group_count() == 0) return;
  Moments f, potential;
  kernels_.far_moments(sources.data(), sources.group_count(), exponent, f.data(), potential.data());
  const double before = far.f[0];
  add_moments(f, potential, exponent, far);
  constexpr double rounding = 1e-6;
  far.f_error += rounding * (far.f[0] - before);
  far.gradient_error += rounding * (far.f[0] - before);
}

std::vector<PieceIndex> NearFar::split(std::span<const Piece> pieces, std::span<const PieceIndex> candidates,
                                       const Vec3d& center, double half, FarField& far) const {
  constexpr double quadrature_share = 0.25;
  const double cube_radius = half * std::sqrt(3.0);
  std::vector<PieceIndex> near;
  near.reserve(candidates.size());
  SourceGroups curves, points;
  for (const PieceIndex i : candidates) {
    const Piece& piece = pieces[i];
    const double d = distance(piece, center);
    if (!is_far(piece, d, cube_radius, far)) {
      near.push_back(i);
      continue;
    }
    const Rule rule = rule_for(piece, d - cube_radius, quadrature_share);
    far.f_error += rule.error.field;
    far.gradient_error += rule.error.gradient;
    add_nodes(piece, rule.nodes, center, half, degree_, piece.is_point() ? points : curves);
  }
  fold(curves, degree_, far);
  fold(points, degree_ - 1, far);
  return near;
}

}  // namespace marrow
