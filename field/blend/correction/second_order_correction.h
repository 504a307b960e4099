// The correction operator over numbers with second derivatives.
#pragma once

#include "field/description/field_node.h"
#include "field/number/functions.h"

namespace marrow {

struct CorrectionRule {
  Kernel kernel;
  bool cavity = true;
  Projection projection = Projection::Paper;
};

/// C(f, G) as of Correction, from f, G^2 = |grad_S f|^2 and alpha. Where C is not twice differentiable (the borders of
/// the cavity branch, of the guard and of the level part of bounded curves, G = 0 without cavity) one side is taken.
HessianJet second_order_correction(const CorrectionRule&, const HessianJet& f, const HessianJet& G_squared,
                                   const HessianJet& alpha);

}  // namespace marrow
