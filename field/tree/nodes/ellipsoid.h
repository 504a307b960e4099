// A ball with a radius for each axis.
#pragma once

#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// The Blobtree's way: a sphere of the smallest radius, stretched with its field. So the surface is exact, and
/// elsewhere the distance is a lower bound only: along an axis the range grows as the radius does.
struct Ellipsoid {
  static constexpr NodeInfo info{"ellipsoid", "A ball stretched along the axes, with its field."};
  Vec3d center{};
  Vec3d radii{1, 1, 1};
  Potential potential;

  static void keys(auto&& key) {
    key("center", &Ellipsoid::center, form::Position{}, "its centre");
    key("radii", &Ellipsoid::radii, form::Sizes{}, "of its surface, along x, y and z");
    key("potential", &Ellipsoid::potential, form::OneOf{},
        "how the field falls; its range holds along the shortest axis and is stretched with the others");
  }
  double least_radius() const { return std::min({radii.x, radii.y, radii.z}); }
  Box3 support() const {
    const Vec3d sides = radii * (1 + range_of(potential) / least_radius());
    return reached({center - sides, center + sides}, 0);
  }

  template <Number X>
  X value(const Vec3<X>& p) const {
    const Vec3<X> v = p - center;
    const Vec3<X> unit{v.x * (1 / radii.x), v.y * (1 / radii.y), v.z * (1 / radii.z)};
    return bounded_field(potential, (length(unit) - 1.0) * least_radius());
  }
};

}  // namespace marrow
