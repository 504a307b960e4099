// Quotients that are smooth where numerator and denominator vanish together.
#pragma once

#include "field/number/functions.h"

namespace marrow {

/// (e^x - 1) / x, 1 at 0.
HessianJet exp_quotient(const HessianJet& x);

/// ln(1 + x) / x, 1 at 0. Precondition: x > -1.
HessianJet log_quotient(const HessianJet& x);

}  // namespace marrow
