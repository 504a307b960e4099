// Bounds of the partial derivatives of the correction operator of the Cauchy and the compact kernel.
#pragma once

#include "field/blend/bounds/correction/correction_bounds.h"

namespace marrow {

/// As partial_bounds(), of a correction with bounded(). Every piece of the operator (chord, curve, its level part,
/// cavity branch) that the intervals meet counts.
///
/// Behind the critical point C is a function of B alone (bounded_correction.h). With u = h^2 / B, sign + Cauchy and
/// - compact, and E = d ln h_D / d ln B = (n + sign) u_D / (1 + (n + 3 sign) u_D - sign n u_D^2), which follows from
/// cos (B - n h^2) = sin h w:
///   gain = p L D_f dC/df(D) + ((p + sign) L - sign E) D_G dC/dG(D),   L = (1 + 2 sign u_D E) / (1 + sign u_D),
///   dC/df = gain (1 - n u) / (p f),   dC/dG = 2 gain u / G = gain G / (2 psi^2 B).
/// All terms are positive, so that C is isotone there whatever the angle.
PartialBounds bounded_partials(const Correction& least, const Interval& alpha, const Interval& value, const Interval& f,
                               const Interval& G);

}  // namespace marrow
