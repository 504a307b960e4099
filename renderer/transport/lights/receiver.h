// The point that is lit, and what a light says to it.
#pragma once

#include "field/math/vec3.h"
#include "materials/rgb.h"

namespace marrow {

/// Shadow rays start at `position`, beside the surface; light counts from the side of `normal`.
struct Receiver {
  Vec3d position;
  UnitVec3 normal;
};

/// `radiance` is to be multiplied by f |cos| and divided by `pdf` (per solid angle). For a light of a single direction
/// (`delta`) it is the irradiance on a surface that faces it, and `pdf` is 1.
struct LightSample {
  UnitVec3 wi;
  Rgb radiance;
  double distance = 0;  ///< infinity for lights at infinity
  double pdf = 0;
  bool delta = false;
};

struct LightHit {
  double t = 0;
  Rgb radiance;
};

}  // namespace marrow
