// From the moments of a line to the sample at a point.
#pragma once

#include <span>

#include "field/kernel/segment_moments.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// d grad_S f / dp of a line: even I + k times the integral of q q^T, q = across - t along, of which `second` holds
/// those of 1, t and t^2. The outer product is split at its left factor.
inline Matrix3 si_jacobian_of(double even, double k, std::span<const double, 3> second, const Vec3d& along,
                              const Vec3d& across) {
  return Matrix3::scaled_identity(even) + Matrix3::outer(across, across * (k * second[0]) - along * (k * second[1])) +
         Matrix3::outer(along, along * (k * second[2]) - across * (k * second[1]));
}

/// `along` is the direction of the line, `across` goes from the foot of the point on it to the point, `degree` is m of
/// the kernel and `scale` multiplies everything.
template <Derivatives Order>
SkeletonSample sample_of(const SegmentMoments& m, const UnitVec3& along, const Vec3d& across, int degree,
                         double scale) {
  const double slope = -degree * scale;
  SkeletonSample s;
  s.value = scale * m.value;
  if constexpr (Order >= Derivatives::First) s.gradient = (across * m.first[0] - along * m.first[1]) * slope;
  s.si_gradient = (across * m.si[0] - along * m.si[1]) * slope;
  if constexpr (Order >= Derivatives::Second)
    s.si_jacobian = si_jacobian_of(slope * m.si[0], -(degree + 2) * slope, m.second, along, across);
  return s;
}

}  // namespace marrow
