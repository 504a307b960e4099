// Sine and cosine of a range of projection angles; internal to blend/.
#pragma once

#include <algorithm>

#include "field/number/interval.h"

namespace marrow {

/// Of angles from 0 to pi/2.
struct Angles {
  Interval sine, cosine;
};

inline Angles angles_of(const Interval& alpha) {
  if (alpha.lo == alpha.hi) return {Interval(sin(alpha.lo)), Interval(cos(alpha.lo))};
  return {{std::max(0.0, rounding::down(sin(alpha.lo), 2)), rounding::up(sin(alpha.hi), 2)},
          {std::max(0.0, rounding::down(cos(alpha.hi), 2)), rounding::up(cos(alpha.lo), 2)}};
}

}  // namespace marrow
