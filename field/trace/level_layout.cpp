#include "field/trace/level_layout.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace marrow {
namespace {

// The largest first derivative and half of the largest second one along any line in the cube, of f and of G. A monomial
// in [-1, 1]^3 has a gradient of at most its degree. Its second derivative along a unit vector e is e.A e, |A_ij| at
// most the sum over monomials of their |second derivatives|, and the largest eigenvalue of a symmetric matrix is at
// most its largest sum of a row. |G'| and |G''| by the length of those of the components.
struct FarRange {
  std::array<float, 4> slope{}, bend{};

  FarRange(const float* far, std::size_t monomial_count) {
    for (std::size_t k = 0; k < 4; ++k) add(far, monomial_count, k);
  }
  // A row of the second derivatives of x^e adds up to e_row (degree - 1).
  void add(const float* far, std::size_t monomial_count, std::size_t k) {
    std::array<float, 3> rows{};
    for (std::size_t i = 1; i < monomial_count; ++i) {
      const Monomial& m = monomials[i];
      const float c = std::fabs(far[4 * i + k]), next = c * static_cast<float>(m.degree() - 1);
      slope[k] += static_cast<float>(m.degree()) * c;
      rows[0] += static_cast<float>(m.a) * next;
      rows[1] += static_cast<float>(m.b) * next;
      rows[2] += static_cast<float>(m.c) * next;
    }
    bend[k] = 0.5001F * std::max({rows[0], rows[1], rows[2]});
  }
  static float length(const std::array<float, 4>& v) { return std::sqrt(v[1] * v[1] + v[2] * v[2] + v[3] * v[3]); }
};

}  // namespace

FieldLevel write_far(const LevelPolynomials& from, float* far) {
  float* out = far;
  for (const auto& monomial : from.coefficients)
    for (const double c : monomial) *out++ = static_cast<float>(c);
  const FarRange range(far, from.coefficients.size());
  FieldLevel level;
  level.far_degree = from.degree;
  level.far = far;
  level.far_slope = range.slope[0];
  level.far_g_slope = FarRange::length(range.slope);
  level.far_bend = range.bend[0];
  level.far_g_bend = FarRange::length(range.bend);
  return level;
}

FieldLevel write_field(const Level& level, float* sources) {
  const auto curve_floats = static_cast<std::size_t>(level.curves.group_count() * floats_per_group);
  std::copy_n(level.curves.data(), curve_floats, sources);
  std::copy_n(level.points.data(), level.source_floats() - curve_floats, sources + curve_floats);
  FieldLevel out = write_far(level.far, sources + level.source_floats());
  out.sources = sources;
  out.curve_groups = level.curves.group_count();
  out.point_groups = level.points.group_count();
  return out;
}

}  // namespace marrow
