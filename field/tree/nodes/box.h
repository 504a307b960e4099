// A box along the axes, with sharp or round edges.
#pragma once

#include <string>

#include "field/tree/distances.h"
#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// The distance is exact.
struct Box {
  static constexpr NodeInfo info{"box", "A box along the axes with a bounded field."};
  Vec3d center{};
  Vec3d size{1, 1, 1};
  double rounding = 0;
  Potential potential;

  static void keys(auto&& key) {
    key("center", &Box::center, form::Position{}, "its centre");
    key("size", &Box::size, form::Sizes{}, "its edges, along x, y and z");
    key("rounding", &Box::rounding, form::Real{.min = 0}, "radius of its edges");
    key("potential", &Box::potential, form::OneOf{}, "how the field falls");
  }
  std::string problem(std::size_t) const {
    const double most = 0.5 * std::min({size.x, size.y, size.z});
    return rounding > most ? "rounding must not be above half of the shortest edge" : "";
  }
  Box3 support() const { return reached({center - size * 0.5, center + size * 0.5}, range_of(potential)); }

  template <Number X>
  X value(const Vec3<X>& p) const {
    const Vec3<X> v = p - center;
    const Vec3d flat = size * 0.5 - Vec3d{rounding, rounding, rounding};
    const Vec3<X> q{abs(v.x) - flat.x, abs(v.y) - flat.y, abs(v.z) - flat.z};
    return bounded_field(potential, corner_distance(q) - rounding);
  }
};

}  // namespace marrow
