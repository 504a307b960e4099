#include "field/trace/cells/ray_spacing.h"

#include <algorithm>
#include <cmath>

namespace marrow {
namespace {

// Of more views as many of them, evenly spread, stand for all: each cube asks, and a cell costs as much as 20,000 of
// them.
constexpr std::size_t enough_views = 4096;

}  // namespace

double RaySpacing::in_cube(const Vec3d& center, double half) const {
  const std::size_t stride = 1 + views.size() / enough_views;
  double rays = 0;  // that cross a unit of area
  for (std::size_t i = 0; i < views.size(); i += stride) {
    const View& v = views[i];
    const double distance = std::max(0.0, length(center - v.eye) - half * std::sqrt(3.0));
    const double spacing = v.constant + v.per_distance * distance;
    rays += static_cast<double>(stride) / (spacing * spacing);
  }
  return views.empty() ? 0 : 1 / std::sqrt(rays);
}

// Figures in the README. Later samples make up for smaller cells.
double RaySpacing::least_cell(const Vec3d& center, double half) const {
  const double rays = samples == 1 ? 12 : 8;
  return rays * in_cube(center, half);
}

}  // namespace marrow
