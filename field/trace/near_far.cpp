#include "field/trace/near_far.h"

#include <algorithm>
#include <cmath>

#include "field/math/elementary.h"

namespace marrow {

NearFar::NearFar(int degree, ErrorBudget budget) : degree_(degree), budget_(budget), quadrature_(degree) {
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
  for (int m = 1; m <= max_gauss_nodes; ++m) {
    const auto e = quadrature_.bound(m, piece.mass, piece.radius, slope, piece.length, distance);
    if (e.field <= share * budget_.field && e.gradient <= share * budget_.gradient) return {m, e};
  }
  return {};
}

std::vector<PieceIndex> NearFar::split(std::span<const Piece> pieces, std::span<const PieceIndex> candidates,
                                       const Vec3d& center, double half, FarField& far) const {
  constexpr double quadrature_share = 0.25;
  const double cube_radius = half * std::sqrt(3.0);
  std::vector<PieceIndex> near;
  FarMoments curves(degree_), points(degree_ - 1);
  for (const PieceIndex i : candidates) {
    const Piece& piece = pieces[i];
    const double d = distance(piece, center);
    if (!is_far(piece, d, cube_radius, far)) {
      near.push_back(i);
      continue;
    }
    if (piece.is_point()) {
      points.add((piece.from - center) / half, integer_power(piece.radius / half, degree_ - 1), piece.radius / half);
      continue;
    }
    // A far piece is at least a cube radius away and no longer than its radius: some rule always serves.
    const Rule found = rule_for(piece, d - cube_radius, quadrature_share);
    const GaussNodes rule = gauss_legendre(std::max(1, found.nodes));
    far.f_error += found.error.field;
    far.gradient_error += found.error.gradient;
    const double unit = piece.mass / integer_power(piece.radius, degree_ - 1) / half;  // L / N in cube units
    for (std::size_t k = 0; k < rule.positions.size(); ++k) {
      const double s = rule.positions[k];
      const double radius = (piece.radius_from + (piece.radius_to - piece.radius_from) * s) / half;
      curves.add((lerp(piece.from, piece.to, s) - center) / half,
                 rule.weights[k] * unit * integer_power(radius, degree_ - 1), radius);
    }
  }
  if (!curves.empty()) curves.add_to(far.f, far.potential);
  if (!points.empty()) points.add_to(far.f, far.potential);
  return near;
}

}  // namespace marrow
