// Widens or narrows space along an axis.
#pragma once

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

  template <Number X>
  Vec3<X> child_point(const Vec3<X>& p) const {
    const Vec3<X> a = constant<X>(axis), v = p - constant<X>(center);
    const X along = dot(v, a);
    const X width = X(start) + X(end - start) * clamp(along / X(length), 0, 1);
    const X less = X(1.0) - X(1.0) / clamp(width, min(start, end), max(start, end));
    return p - (v - a * along) * less;
  }
};

}  // namespace marrow
