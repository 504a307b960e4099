// What a lobe says about a pair of directions, and what it draws.
#pragma once

#include "field/math/vec3.h"
#include "materials/rgb.h"
#include "materials/sample.h"

namespace marrow {

struct Scattered {
  Rgb f_cos;       ///< f |cos wi|
  double pdf = 0;  ///< per solid angle
};

struct BsdfSample {
  UnitVec3 wi;
  Rgb weight;      ///< f |cos wi| / pdf
  double pdf = 0;  ///< per solid angle
};

}  // namespace marrow
