// The correction of Cauchy and compact kernels over numbers with second derivatives; internal to blend/.
#pragma once

#include "field/blend/correction/bounded_correction.h"
#include "field/blend/correction/second_order_correction.h"

namespace marrow {

/// `behind`: in the cavity branch. The angle is given by its sine and cosine, both >= 0.
HessianJet second_order_bounded(const BoundedCorrection&, const CorrectionRule&, bool behind, const HessianJet& f,
                                const HessianJet& G_squared, const HessianJet& sine, const HessianJet& cosine);

}  // namespace marrow
