// A flat disc with a round rim.
#pragma once

#include "field/tree/distances.h"
#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// The distance is exact.
struct Disc {
  static constexpr NodeInfo info{"disc", "A flat disc, thickened, with a round rim and a bounded field."};
  Vec3d center{};
  UnitVec3 axis = UnitVec3::unchecked({0, 1, 0});
  double radius = 1, thickness = 0.2;
  Potential potential;

  static void keys(auto&& key) {
    key("center", &Disc::center, form::Position{}, "its centre");
    key("axis", &Disc::axis, form::Direction{}, "across the disc");
    key("radius", &Disc::radius, form::positive, "of the flat disc; the rim reaches half a thickness further");
    key("thickness", &Disc::thickness, form::positive, "from face to face");
    key("potential", &Disc::potential, form::OneOf{}, "how the field falls");
  }
  Box3 support() const { return reached(disc_box(center, axis, radius), 0.5 * thickness + range_of(potential)); }

  template <Number X>
  X value(const Vec3<X>& p) const {
    const FromAxis<X> q = from_axis(p, center, axis);
    return bounded_field(potential, length(max(q.radius - radius, X(0.0)), q.along) - 0.5 * thickness);
  }
};

}  // namespace marrow
