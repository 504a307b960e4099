// From the moments of a line to the sample at a point.
#pragma once

#include "field/kernel/segment_moments.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// `along` is the direction of the line, `across` goes from the foot of the point on it to the point, `degree` is m of
/// the kernel and `scale` multiplies everything.   [field-maths 3.3, 5]
template <Derivatives Order>
SkeletonSample sample_of(const SegmentMoments& m, const UnitVec3& along, const Vec3d& across, int degree,
                         double scale) {
  const double slope = -degree * scale;
  SkeletonSample s;
  s.value = scale * m.value;
  if constexpr (Order >= Derivatives::First) s.gradient = (across * m.first[0] - along * m.first[1]) * slope;
  s.si_gradient = (across * m.si[0] - along * m.si[1]) * slope;
  if constexpr (Order >= Derivatives::Second) {
    // slope (I si_0 - (m+2) sum of q q^T weights, q = across - t along), the outer product split at its left factor
    const double k = -(degree + 2) * slope;
    s.si_jacobian = Matrix3::scaled_identity(slope * m.si[0]) +
                    Matrix3::outer(across, across * (k * m.second[0]) - along * (k * m.second[1])) +
                    Matrix3::outer(along, along * (k * m.second[2]) - across * (k * m.second[1]));
  }
  return s;
}

}  // namespace marrow
