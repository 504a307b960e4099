// A ray against boxes, and in the coordinates of a cube.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "field/math/box3.h"
#include "field/math/ray.h"
#include "field/trace/kernels/block_kernels.h"

namespace marrow {

/// [t_enter, t_exit] of the ray in a box; the same plane gives the same t in neighbouring cells.
inline std::pair<double, double> clip(const Box3& box, const Ray& ray, const Vec3d& inverse_direction) {
  double enter = ray.t_min, exit = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const double o = ray.origin[i], k = inverse_direction[i];
    if (std::isinf(k)) {
      if (o < box.lower[i] || o > box.upper[i]) return {1, 0};
      continue;
    }
    const double a = (box.lower[i] - o) * k, b = (box.upper[i] - o) * k;
    enter = std::max(enter, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return {enter, exit};
}

/// A ray in the coordinates of a cube, with t counted from its point nearest to the centre of the cube.
struct RayInCube {
  double t_near, half;
  LocalRay local;

  RayInCube() = default;
  RayInCube(const Ray& ray, const Vec3d& center, double cube_half)
      : t_near(dot(center - ray.origin, ray.direction)), half(cube_half) {
    const double scale = 1 / half;
    const Vec3d start = (ray.origin - center + ray.direction * t_near) * scale;
    for (std::size_t i = 0; i < 3; ++i) {
      local.origin[i] = static_cast<float>(start[i]);
      local.direction[i] = static_cast<float>(ray.direction.vec()[i]);
    }
  }
  float to_local(double t) const { return static_cast<float>((t - t_near) / half); }
  double to_world(float t) const { return t_near + static_cast<double>(t) * half; }
};

}  // namespace marrow
