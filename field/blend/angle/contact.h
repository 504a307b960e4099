// The projection angle at which two equal skeletons join exactly when their surfaces touch.
#pragma once

#include "field/description/field_node.h"

namespace marrow {

/// The alpha with C(2, 0) = 1: midway between two equal points, infinite lines or planes two radii apart, f = 2
/// and grad_S f = 0. Found by bisection to the last bits; in (0, pi/2).   [Zanni et al. 2015, sec. 5]
double contact_alpha(int degree, bool cavity = true, Projection = Projection::Paper);

/// The same for any kernel. Where even alpha = 0 joins two such skeletons before they touch (C(2, 0) >= 1 there: wide
/// supports, small scales), or lone ones are hollow at the angle that is exact, nothing is: with cavity correction the
/// angle without it is given, or if a lone skeleton were hollow then, the least at which it is not. Without cavity
/// correction hollows stay.
struct ContactAngle {
  double alpha;
  bool is_exact;
};
ContactAngle contact_angle(const Kernel&, bool cavity = true, Projection = Projection::Paper);
double contact_alpha(const Kernel&, bool cavity = true, Projection = Projection::Paper);

}  // namespace marrow
