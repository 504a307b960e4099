// Derivatives of what is defined by an equation.
#pragma once

#include "field/number/functions.h"

namespace marrow {

/// x(p) with f(x(p), p) = 0, from a root x at one p and the slope of f by x there: each step x - f(x) / slope makes the
/// derivatives of one more order right, and the value better.   f: HessianJet -> HessianJet, slope not 0
template <class Function>
HessianJet implicit_root(double root, double slope, const Function& f) {
  HessianJet x(root);
  for (int order = 0; order < 3; ++order) x = x - f(x) * (1 / slope);
  return x;
}

}  // namespace marrow
