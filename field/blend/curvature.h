// Second derivatives of a blend, and the curvature of its level surfaces.
#pragma once

#include "field/blend/blend_field.h"
#include "field/math/matrix3.h"
#include "field/number/jet.h"

namespace marrow {

/// The six second derivatives as a symmetric matrix.
Matrix3 hessian_of(const HessianJet&);

/// The Hessian of the plain sum f, from the second derivatives of every skeleton in closed form, or under its integral
/// (field/skeleton/second_order.h). 0 on a skeleton.
Matrix3 sum_hessian(const BlendField&, const Vec3d& p);

/// The corrected field with its gradient and Hessian, in closed form: for every skeleton, kernel, projection and rule
/// of the angle. Where the correction has a kink (where the branch of the cavity begins, for the paper's projection)
/// the Hessian is that of one side. On a skeleton +infinity and 0.
HessianJet second_order_corrected(const BlendField&, const Vec3d& p);
Matrix3 corrected_hessian(const BlendField&, const Vec3d& p);

/// Of the level surface through a point, from the gradient and the Hessian there, in 1/length and 1/length^2. A body is
/// inside where the field is larger: a ball of radius r has mean 1/r. 0 where the gradient vanishes.
struct Curvature {
  double mean = 0, gaussian = 0;
};
Curvature curvature_of(const Vec3d& gradient, const Matrix3& hessian);

}  // namespace marrow
