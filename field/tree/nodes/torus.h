// A ring.
#pragma once

#include "field/tree/distances.h"
#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// The distance is exact; but where the tube is wider than the ring, it is a bound inside.
struct Torus {
  static constexpr NodeInfo info{"torus", "A ring with a bounded field."};
  Vec3d center{};
  UnitVec3 axis = UnitVec3::unchecked({0, 1, 0});
  double radius = 1, tube = 0.25;
  Potential potential;

  static void keys(auto&& key) {
    key("center", &Torus::center, form::Position{}, "its centre");
    key("axis", &Torus::axis, form::Direction{}, "across the ring");
    key("radius", &Torus::radius, form::positive, "from its centre to the middle of the tube");
    key("tube", &Torus::tube, form::positive, "radius of the tube");
    key("potential", &Torus::potential, form::OneOf{}, "how the field falls");
  }
  Box3 support() const { return reached(disc_box(center, axis, radius), tube + range_of(potential)); }

  template <Number X>
  X value(const Vec3<X>& p) const {
    const FromAxis<X> q = from_axis(p, center, axis);
    return bounded_field(potential, length(q.radius - radius, q.along) - tube);
  }
};

}  // namespace marrow
