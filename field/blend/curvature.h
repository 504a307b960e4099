// Second derivatives of a blend, and the curvature of its level surfaces.
#pragma once

#include "field/blend/blend_field.h"
#include "field/math/matrix3.h"

namespace marrow {

/// The Hessian of the plain sum f. From the formulas of points, and of segments and surfaces of constant radius (there
/// it is the Jacobian of grad_S f over the radius); of segments of linear radius from the same integral; of all others
/// (linear radius on arcs and triangles, the distance model, Cani and Hornus) by differences of their gradients, to
/// 1e-8. 0 on a skeleton.
Matrix3 sum_hessian(const BlendField&, const Vec3d& p);

/// The Hessian of the corrected field, by differences of its gradient in closed form, to some 1e-8; of no meaning where
/// the gradient has a kink (where the branch of the cavity begins, for the paper's projection).
Matrix3 corrected_hessian(const BlendField&, const Vec3d& p);

/// Of the level surface through a point, from the gradient and the Hessian there, in 1/length and 1/length^2. A body is
/// inside where the field is larger: a ball of radius r has mean 1/r. 0 where the gradient vanishes.
struct Curvature {
  double mean = 0, gaussian = 0;
};
Curvature curvature_of(const Vec3d& gradient, const Matrix3& hessian);

}  // namespace marrow
