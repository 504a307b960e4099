// Walks a ray through the 4 x 4 x 4 sub-cells of a block and gives the stretches that may hold surface.
#pragma once

#include <cstdint>

#include "field/math/vec3.h"

namespace marrow {

/// Steps from sub-cell to sub-cell (Amanatides and Woo 1987) over [t0, t1], all in block coordinates.
class MaskWalk {
 public:
  /// `inverse_direction` is 1 / direction, infinite where that is 0.
  MaskWalk(std::uint64_t mask, const Vec3d& origin, const Vec3d& direction, const Vec3d& inverse_direction, double t0,
           double t1);

  struct Stretch {
    double begin, end;
  };
  /// The next maximal stretch of sub-cells that are set in the mask; false when there is none left.
  bool next(Stretch&);

 private:
  bool marked() const { return mask_ >> (cell_[0] + 4 * cell_[1] + 16 * cell_[2]) & 1; }
  /// To the next sub-cell; false when it lies outside the block or beyond the end.
  bool advance();

  std::uint64_t mask_;
  double t_, end_;
  double crossing_[3], delta_[3];
  int cell_[3], step_[3];
  bool done_ = false;
};

}  // namespace marrow
