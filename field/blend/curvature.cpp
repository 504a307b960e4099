// Hessians put together, and curvature from gradient and Hessian.
#include "field/blend/curvature.h"

#include "field/blend/correction/second_order_correction.h"
#include "field/blend/second_order_gather.h"

namespace marrow {

Matrix3 hessian_of(const HessianJet& f) {
  Matrix3 m;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = HessianJet::at[k];
    m.rows[i][j] = m.rows[j][i] = f.curvature[k];
  }
  return m;
}

Matrix3 sum_hessian(const BlendField& blend, const Vec3d& p) {
  return hessian_of(second_order_gather(blend, p).sum.field);
}

HessianJet second_order_corrected(const BlendField& blend, const Vec3d& p) {
  const auto [sum, alpha] = second_order_gather(blend, p);
  const CorrectionRule rule{kernel_of(blend), blend.cavity, blend.projection};
  return second_order_correction(rule, sum.field, square(sum.si.x) + square(sum.si.y) + square(sum.si.z), alpha);
}

Matrix3 corrected_hessian(const BlendField& blend, const Vec3d& p) {
  return hessian_of(second_order_corrected(blend, p));
}

// With the outward normal n = -g / |g|: mean = div n / 2, and the Gaussian one from the adjugate of the Hessian.
Curvature curvature_of(const Vec3d& g, const Matrix3& hessian) {
  const double slope = length(g);
  if (!(slope > 0)) return {};
  const Vec3d n = g / slope;
  const auto& [x, y, z] = hessian.rows;
  const Vec3d bent = hessian.times(n);
  const double trace = x.x + y.y + z.z;
  const Vec3d adjugate_n = cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
  return {.mean = (dot(n, bent) - trace) / (2 * slope), .gaussian = dot(n, adjugate_n) / (slope * slope)};
}

}  // namespace marrow
