// Field of a triangle of linear radius by integrals along its sides; internal to skeleton/.
#pragma once

#include <optional>

#include "field/skeleton/plate.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// Integrals of tau^e d^-m over the triangle from those with lower powers. With tau = tau_0 + g x from the foot of the
/// point and the gradient of d^-(m-2) over the plane, -(m-2) x d^-m, integration by parts gives
///   T(e, m) = tau_0 T(e-1, m) + ((e-1) g^2 T(e-2, m-2) - sum of sides (g out) int tau^(e-1) d^-(m-2) dt) / (m-2).
/// Nothing where that would lose more than some three digits, as is found on the way: where the thick end of the
/// triangle tells more than what is nearest.
template <Derivatives>
std::optional<SkeletonSample> tapered_plate_field(const Plate&, int family_degree);

}  // namespace marrow
