// A half-space.
#pragma once

#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// The distance is exact. Deep inside the field is constant, as in every bounded primitive.
struct Plane {
  static constexpr NodeInfo info{"plane", "All that lies behind a plane, with a field that ends before it."};
  Vec3d point{};
  UnitVec3 normal = UnitVec3::unchecked({0, 1, 0});
  Potential potential;

  static void keys(auto&& key) {
    key("point", &Plane::point, form::Position{}, "a point of the plane");
    key("normal", &Plane::normal, form::Direction{}, "points out of the solid half");
    key("potential", &Plane::potential, form::OneOf{}, "how the field falls");
  }
  Box3 support() const;

  template <Number X>
  X value(const Vec3<X>& p) const {
    return bounded_field(potential, dot(p - point, normal));
  }
};

}  // namespace marrow
