#include "field/trace/ray_spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marrow {

double RaySpacing::in_cube(const Vec3d& center, double half) const {
  if (views.empty()) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const View& v : views) {
    const double distance = std::max(0.0, length(center - v.eye) - half * std::sqrt(3.0));
    least = std::min(least, v.constant + v.per_distance * distance);
  }
  return least;
}

// Figures in the README. Later samples make up for smaller cells.
double RaySpacing::least_cell(const Vec3d& center, double half) const {
  const double rays = come_once ? 12 : 8;
  return rays * in_cube(center, half);
}

}  // namespace marrow
