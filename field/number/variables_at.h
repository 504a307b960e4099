// A position as the variables of numbers that carry derivatives, and the gradient that these then carry.
#pragma once

#include "field/math/vec3.h"

namespace marrow {

/// p, whose coordinates are the variables 0, 1 and 2 of X: Jet<T, 3> or HessianJet.
template <class X>
Vec3<X> variables_at(const Vec3<typename X::Scalar>& p) {
  return {X::variable(p.x, 0), X::variable(p.y, 1), X::variable(p.z, 2)};
}

/// By the position whose coordinates are the variables.
template <class X>
Vec3<typename X::Scalar> gradient_of(const X& f) {
  return {f.slope[0], f.slope[1], f.slope[2]};
}

}  // namespace marrow
