// A half line with a parameter interval.
#pragma once

#include <limits>

#include "field/math/vec3.h"

namespace marrow {

struct Ray {
  Vec3d origin;
  UnitVec3 direction;
  double t_min = 0;
  double t_max = std::numeric_limits<double>::infinity();

  Vec3d at(double t) const { return origin + direction * t; }
};

}  // namespace marrow
