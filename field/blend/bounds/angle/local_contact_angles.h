// Bounds of the contact angle that adapts to the place; internal to blend/.
#pragma once

#include "field/blend/angle/local_contact.h"
#include "field/blend/bounds/angle/alpha_bounds.h"

namespace marrow {

/// Of a blend that has `local_contact`, from bounds of its sums with their parts: the angle (radians) and its gradient
/// in the middle, and how fast both change in the box. With N the near field and e, q those of the rule,
/// crowd = (f N^-e)^q:
///   spread / 4 = A - B^2,   A and B the means of (l - l_0)^2 and l - l_0, l the logarithm of a radius, weighted by the
///     fields, l_0 that mean in the middle, where B = 0: so it changes as A, and with 2 B grad B;
///   ln crowd = q (ln f - e ln N), both sums of fields with logarithms.
/// Where the least or the largest angle may take over, or fields have no second derivatives (by distance), to first
/// order; near skeletons, and where one segment of a strand by distance takes over from another, all angles of the rule
/// with any gradient.
AngleBounds local_contact_angles(const BlendField&, const SumBounds&);
/// The same to first order, where sums have no parts: from what the rule is told in the middle, and |grad ln| of near
/// fields at most.
AngleBounds local_contact_angles(const BlendField&, const Neighbourhood&, double near_log_slope, const SumBounds&);

}  // namespace marrow
