#include "field/trace/ray_spacing.h"

#include <algorithm>
#include <cmath>

namespace marrow {

double RaySpacing::in_cube(const Vec3d& center, double half) const {
  double rays = 0;  // that cross a unit of area
  for (const View& v : views) {
    const double distance = std::max(0.0, length(center - v.eye) - half * std::sqrt(3.0));
    const double spacing = v.constant + v.per_distance * distance;
    rays += 1 / (spacing * spacing);
  }
  return views.empty() ? 0 : 1 / std::sqrt(rays);
}

// Figures in the README. Later samples make up for smaller cells.
double RaySpacing::least_cell(const Vec3d& center, double half) const {
  const double rays = come_once ? 12 : 8;
  return rays * in_cube(center, half);
}

}  // namespace marrow
