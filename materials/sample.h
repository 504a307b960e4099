// Points of the unit square and cube that drive random choices.
#pragma once

namespace marrow {

/// Each coordinate in [0, 1).
struct Sample2 {
  double x = 0, y = 0;
};
/// `xy` chooses a direction, `z` a lobe.
struct Sample3 {
  Sample2 xy;
  double z = 0;
};

}  // namespace marrow
