// A half line with a parameter interval.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/vec3.h"

namespace marrow {

struct FieldAround;

struct Ray {
  Vec3d origin;
  UnitVec3 direction;
  double t_min = 0;
  double t_max = std::numeric_limits<double>::infinity();
  /// Where the ray leaves a surface, outside: what is known of the field there; null: nothing. It must outlive the ray,
  /// and be of the surfaces that the ray is traced in. With it the ray gets away sooner; it meets the same surfaces, to
  /// within what they are resolved to.
  const FieldAround* around = nullptr;

  Vec3d at(double t) const { return origin + direction * t; }
  /// What at(t) rounds goes by: the way, or the largest coordinate of the origin.
  double size_at(double t) const { return std::max(std::fabs(t), max_component(abs(origin))); }
};

}  // namespace marrow
