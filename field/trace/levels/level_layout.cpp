#include "field/trace/levels/level_layout.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "field/trace/sources/polynomial_bend.h"

namespace marrow {
namespace {

// By which bends are raised. Each is found in double and rounded to a float, 2^-24; the length of three takes half of a
// square's rounding and two sums', and a root's own, 5/2 of that; what kernels make of it (Marcher::bend_by(),
// depart()) takes ten operations more at most. So 1 + 8e-7 is enough; the rest is room for kernels that change.
constexpr double raise = 1.0002;
static_assert(raise - 1 > (1 + 2.5 + 10) * 0x1p-24);

// The largest first derivative and half of the largest second one along any line in the cube, of f and of G. A monomial
// in [-1, 1]^3 has a gradient of at most its degree. |G'| and |G''| by the length of those of the components.
// Slopes add up to 55 positive floats: they are within 58 x 2^-24 = 3.5e-6 of themselves, less than `rounding` of
// kernels/sample.h, by which kernels/cube.h raises what it makes of them.
struct FarRange {
  std::array<float, 4> slope{}, bend{};

  FarRange(const float* far, std::size_t monomial_count) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 1; i < monomial_count; ++i)
        slope[k] += static_cast<float>(monomials[i].degree()) * std::fabs(far[4 * i + k]);
      const double bends = polynomial_bend(monomial_count, [&](std::size_t i) { return far[4 * i + k]; });
      bend[k] = static_cast<float>(raise * bends);
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
