// A cone, cut or with its tip.
#pragma once

#include <string>
#include <vector>

#include "field/tree/distances.h"
#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// The distance is exact.
struct Cone {
  static constexpr NodeInfo info{"cone", "A cone with flat ends and a bounded field."};
  Vec3d from{0, -1, 0}, to{0, 1, 0};
  std::vector<double> radius{1, 0};
  Potential potential;

  static void keys(auto&& key) {
    key("from", &Cone::from, form::Position{}, "centre of one end");
    key("to", &Cone::to, form::Position{}, "centre of the other end");
    key("radius", &Cone::radius, form::Reals{.min = 0}, "[at from, at to]; 0 is a tip");
    key("potential", &Cone::potential, form::OneOf{}, "how the field falls");
  }
  std::string problem(std::size_t) const;
  Box3 support() const;

  template <Number X>
  X value(const Vec3<X>& p) const {
    const FromAxis<X> q = from_axis(p, from, normalize(to - from));
    return bounded_field(potential, distance(q.radius, q.along));
  }

 private:
  /// In the plane of the axis, where the cone is convex: outside, the nearest of its three sides; inside, the largest
  /// of the distances to their lines.
  template <Number X>
  X distance(const X& r, const X& z) const {
    const double height = length(to - from), growth = radius.back() - radius.front();
    const double side = std::sqrt(height * height + growth * growth);
    const X s = r - radius.front();
    const X across = s * (height / side) - z * (growth / side), along = s * (growth / side) + z * (height / side);
    const X low = -z, high = z - height, zero(0.0);
    const X inside = max(max(low, high), across);
    // On the surface itself the inner distance counts: lengths have no slope at 0.
    return piecewise(
        -inside, 0,
        [&](const X&) {
          const X bottom = length(max(s, zero), z), top = length(max(r - radius.back(), zero), high);
          return min(length(across, excess(along, side)), min(bottom, top));
        },
        [](const X& depth) { return -depth; });
  }
};

}  // namespace marrow
