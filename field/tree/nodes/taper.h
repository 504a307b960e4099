// Widens or narrows space along an axis.
#pragma once

#include <cstddef>

#include "field/math/affine.h"
#include "field/math/box3.h"
#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// What is across the axis grows by a factor that changes evenly from `start` to `end` over `length`, and stays what it
/// is before and behind.   [Barr 1984]
struct Taper {
  static constexpr NodeInfo info{"taper", "Widens or narrows its child along an axis.", 1, 1};
  Vec3d center{};
  UnitVec3 axis = UnitVec3::unchecked({0, 1, 0});
  double length = 1, start = 1, end = 1;

  static void keys(auto&& key) {
    key("center", &Taper::center, form::Position{}, "the point of the axis where the change begins");
    key("axis", &Taper::axis, form::Direction{}, "direction of the axis, along which nothing moves");
    key("length", &Taper::length, form::positive, "of the part of the axis over which the width changes");
    key("start", &Taper::start, form::positive, "factor of the width at `center` and before");
    key("end", &Taper::end, form::positive, "factor of the width at the end of the length and behind");
  }
  Box3 support(const Box3& child) const;

  /// The same as a placement of the child. Precondition: the width is the same everywhere.
  Affine parent_from_child() const {
    const Vec3d a = axis.vec();
    Affine map = Affine::scale({start, start, start});
    for (std::size_t k = 0; k < 3; ++k) map.columns[k] += a * ((1 - start) * a[k]);
    map.translation = center - map.vector(center);
    return map;
  }

  template <Number X>
  Vec3<X> child_point(const Vec3<X>& p) const {
    const Frame frame = Frame::around(axis);
    const Vec3<X> x = constant<X>(frame.x), y = constant<X>(frame.y), z = constant<X>(frame.z);
    const Vec3<X> v = p - constant<X>(center);
    const X along = dot(v, z);
    const X width = X(start) + X(end - start) * clamp(along / X(length), 0, 1);
    // Each coordinate by itself: taken away from p, what is across would be counted twice by enclosures.
    const X less = X(1.0) / clamp(width, min(start, end), max(start, end));
    return constant<X>(center) + x * (dot(v, x) * less) + y * (dot(v, y) * less) + z * along;
  }
};

}  // namespace marrow
