// A cylinder with flat ends.
#pragma once

#include <string>

#include "field/tree/distances.h"
#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// The distance is exact.
struct Cylinder {
  static constexpr NodeInfo info{"cylinder", "A cylinder with flat ends and a bounded field."};
  Vec3d from{0, -1, 0}, to{0, 1, 0};
  double radius = 0.5;
  Potential potential;

  static void keys(auto&& key) {
    key("from", &Cylinder::from, form::Position{}, "centre of one end");
    key("to", &Cylinder::to, form::Position{}, "centre of the other end");
    key("radius", &Cylinder::radius, form::positive, "of its surface");
    key("potential", &Cylinder::potential, form::OneOf{}, "how the field falls");
  }
  std::string problem(std::size_t) const { return from == to ? "from and to must differ" : ""; }
  Box3 support() const {
    const UnitVec3 axis = normalize(to - from);
    Box3 solid = disc_box(from, axis, radius);
    solid.include(disc_box(to, axis, radius));
    return reached(solid, range_of(potential));
  }

  template <Number X>
  X value(const Vec3<X>& p) const {
    const double half = 0.5 * length(to - from);
    const FromAxis<X> q = from_axis(p, (from + to) * 0.5, normalize(to - from));
    return bounded_field(potential, corner_distance(q.radius - radius, abs(q.along) - half));
  }
};

}  // namespace marrow
