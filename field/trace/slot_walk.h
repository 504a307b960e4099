// Walks a ray through the 4 x 4 x 4 slots of a tile, front to back.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/math/vec3.h"

namespace marrow {

/// Steps from slot to slot (Amanatides and Woo 1987) over [t0, t1]. The stretches of the slots follow each other
/// without a gap; slot x + 4 y + 16 z.
class SlotWalk {
 public:
  /// In the coordinates of the tile, [-1, 1]^3, with t in them too; `inverse_direction` is infinite where that is 0.
  SlotWalk(const Vec3d& origin, const Vec3d& direction, const Vec3d& inverse_direction, double t0, double t1)
      : begin_(t0), last_(t1) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double at = (origin[i] + direction[i] * t0 + 1) * 2;
      at_[i] = std::clamp(static_cast<int>(at), 0, 3);
      step_[i] = direction[i] > 0 ? 1 : -1;
      delta_[i] = 0.5 * std::fabs(inverse_direction[i]);
      const double plane = -1 + 0.5 * (at_[i] + (step_[i] > 0 ? 1 : 0));
      crossing_[i] =
          direction[i] == 0 ? std::numeric_limits<double>::infinity() : (plane - origin[i]) * inverse_direction[i];
    }
    find_end();
  }

  int slot() const { return at_[0] + 4 * at_[1] + 16 * at_[2]; }
  double begin() const { return begin_; }
  double end() const { return end_; }
  /// To the next slot; false at the end.
  bool advance() {
    begin_ = end_;
    if (begin_ >= last_) return false;
    crossing_[axis_] += delta_[axis_];
    at_[axis_] += step_[axis_];
    if (at_[axis_] < 0 || at_[axis_] > 3) return false;
    find_end();
    return true;
  }

 private:
  void find_end() {
    axis_ = crossing_[0] < crossing_[1] ? 0 : 1;
    if (crossing_[2] < crossing_[axis_]) axis_ = 2;
    end_ = std::min(last_, std::max(begin_, crossing_[axis_]));
  }

  double begin_, end_ = 0, last_;
  double crossing_[3], delta_[3];
  int at_[3], step_[3], axis_ = 0;
};

}  // namespace marrow
