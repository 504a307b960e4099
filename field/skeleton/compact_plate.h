// Field of a triangle of one radius under the compact kernel by integrals along its sides; internal to skeleton/.
#pragma once

#include "field/description/field_node.h"
#include "field/skeleton/plate.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// In units of the radius the kernel at the distance rho from the foot of the point is g^(m/2), with
///   g = c - rho^2 / R^2,   c = 1 - h^2 / R^2,
/// and 0 beyond the support, where g < 0. Its integral over rho is R^2 / (m + 2) (c^M - g^M) rho^-1, M = m/2 + 1, so
/// that in polar coordinates about the foot the field is R^2 / (m + 2) J(M) / N with
///   J(M) = integral over the border, by the angle as seen from the foot, of c^M - max(g, 0)^M,
/// and dJ(M) / dh = -2 h M / R^2 J(M - 1).
/// Precondition: plate.is_even(), and it is not so narrow against its distance that its sides cancel.
template <Derivatives>
SkeletonSample compact_plate_field(const Plate&, const Kernel&);

}  // namespace marrow
