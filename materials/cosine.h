// Directions of the hemisphere around z by their cosine.
#pragma once

#include <algorithm>
#include <numbers>

#include "field/math/elementary.h"
#include "field/math/vec3.h"
#include "materials/sample.h"

namespace marrow {

/// Density cos / pi per solid angle; the cosine is never 0.
inline UnitVec3 sample_cosine(Sample2 u) {
  const double radius = std::sqrt(u.x);
  const SinCos phi = sincos(2 * std::numbers::pi * u.y);
  return UnitVec3::unchecked({radius * phi.cos, radius * phi.sin, std::sqrt(std::max(1 - u.x, 1e-32))});
}
constexpr double cosine_pdf(const UnitVec3& w) { return w.z() > 0 ? w.z() * std::numbers::inv_pi : 0; }

}  // namespace marrow
