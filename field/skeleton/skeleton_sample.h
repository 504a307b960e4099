// What one skeleton primitive, or a sum of them, gives at a point.
#pragma once

#include <limits>

#include "field/kernel/derivatives.h"
#include "field/math/matrix3.h"
#include "field/math/vec3.h"

namespace marrow {

/// Values above this count as infinite: the point lies on the skeleton to all purposes (for n = 3 at 1e-30 of the
/// radius), and below it no derivative overflows.
inline constexpr double field_ceiling = 1e60;

/// Sums are plain: add samples to get the field of several primitives.
/// On the skeleton itself value is +infinity and every derivative 0.
struct SkeletonSample {
  double value = 0;       ///< f = (1/N) integral k(d/tau) / tau^dimension
  Vec3d gradient{};       ///< df / dp
  Vec3d si_gradient{};    ///< grad_S f: the same with k' replaced by tau k'   [Zanni et al. 2015, sec. 4.1]
  Matrix3 si_jacobian{};  ///< d grad_S f / dp; symmetric except for distance segments of varying radius

  static SkeletonSample on_skeleton() { return {.value = std::numeric_limits<double>::infinity()}; }
  SkeletonSample& operator+=(const SkeletonSample& b) {
    value += b.value;
    gradient += b.gradient;
    si_gradient += b.si_gradient;
    si_jacobian += b.si_jacobian;
    return *this;
  }
};

}  // namespace marrow
