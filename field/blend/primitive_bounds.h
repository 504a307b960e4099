// What is known of one primitive in a small ball.
#pragma once

#include "field/math/box3.h"
#include "field/number/interval.h"
#include "field/skeleton/skeleton_sample.h"

namespace marrow {

/// SumBounds finds it for the ball around a box, and the angle in the middle follows from the samples.
struct PrimitiveBounds {
  SkeletonSample sample{};  ///< with its gradient; nothing where the skeleton may be met
  Interval f{};
  double steepest = Box3::inf, bent = Box3::inf;  ///< of |grad f| and |D^2 f| at most
  double distance = 0;  ///< above 0: of a sum of w |p - q|^-m with all q so far away, perhaps in four dimensions
  int m = 1;
  Interval scaled{0, Box3::inf};   ///< least distance over the radius there, of primitives by distance
  double place_speed = Box3::inf;  ///< of arcs by distance: how fast the angle of the nearest place moves at most

  /// Not where it has no field in the ball, nor where another segment of its strand by distance is the largest there.
  bool counts() const { return sample.value > 0 || f.hi > 0; }
};

}  // namespace marrow
