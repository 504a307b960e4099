// A whole circle about the z axis, of one thickness.
#pragma once

#include "field/skeleton/skeletons.h"

namespace marrow::test {

inline ArcSkeleton ring_of(double major, double radius) {
  ArcSkeleton ring;
  ring.major = major;
  ring.radius_from = ring.radius_to = radius;
  return ring;
}

}  // namespace marrow::test
