// A ball.
#pragma once

#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// The distance is exact.
struct Sphere {
  static constexpr NodeInfo info{"sphere", "A ball with a bounded field."};
  Vec3d center{};
  double radius = 1;
  Potential potential;

  static void keys(auto&& key) {
    key("center", &Sphere::center, form::Position{}, "its centre");
    key("radius", &Sphere::radius, form::positive, "of its surface");
    key("potential", &Sphere::potential, form::OneOf{}, "how the field falls");
  }
  Box3 support() const { return reached({center, center}, radius + range_of(potential)); }

  template <Number X>
  X value(const Vec3<X>& p) const {
    return bounded_field(potential, length(p - center) - radius);
  }
};

}  // namespace marrow
