#include "field/trace/level_layout.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "field/trace/polynomial_bend.h"

namespace marrow {
namespace {

// The largest first derivative and half of the largest second one along any line in the cube, of f and of G. A monomial
// in [-1, 1]^3 has a gradient of at most its degree. |G'| and |G''| by the length of those of the components.
struct FarRange {
  std::array<float, 4> slope{}, bend{};

  FarRange(const float* far, std::size_t monomial_count) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 1; i < monomial_count; ++i)
        slope[k] += static_cast<float>(monomials[i].degree()) * std::fabs(far[4 * i + k]);
      const double bends = polynomial_bend(monomial_count, [&](std::size_t i) { return far[4 * i + k]; });
      bend[k] = static_cast<float>(1.0002 * bends);
    }
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

FieldLevel write_sources(const SourceGroups& curves, const SourceGroups& points, float* sources) {
  FieldLevel level;
  level.sources = sources;
  level.curve_groups = curves.group_count();
  level.point_groups = points.group_count();
  float* const behind = std::copy_n(curves.data(), level.curve_groups * floats_per_group, sources);
  std::copy_n(points.data(), level.point_groups * floats_per_group, behind);
  return level;
}

FieldLevel write_field(const Level& level, float* sources) {
  const FieldLevel near = write_sources(level.curves, level.points, sources);
  FieldLevel out = write_far(level.far, sources + source_floats(level.curves, level.points));
  out.sources = near.sources;
  out.curve_groups = near.curve_groups;
  out.point_groups = near.point_groups;
  return out;
}

}  // namespace marrow
