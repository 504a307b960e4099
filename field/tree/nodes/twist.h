// Twists space about an axis.
#pragma once

#include "field/math/box3.h"
#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// Planes across the axis turn about it, evenly along it.   [Barr 1984]
struct Twist {
  static constexpr NodeInfo info{"twist", "Turns its child about an axis, evenly along it.", 1, 1};
  Vec3d center{};
  UnitVec3 axis = UnitVec3::unchecked({0, 1, 0});
  double angle_per_length = 0;  ///< radians

  static void keys(auto&& key) {
    key("center", &Twist::center, form::Position{}, "a point of the axis, where nothing turns");
    key("axis", &Twist::axis, form::Direction{}, "direction of the axis");
    key("angle", &Twist::angle_per_length, form::Angle{.min_deg = -1e9, .max_deg = 1e9},
        "turn for each unit of length, in degrees");
  }
  /// Whatever turns stays within its distance from the axis.
  Box3 support(const Box3& child) const;

  template <Number X>
  Vec3<X> child_point(const Vec3<X>& p) const {
    const Frame frame = Frame::around(axis);
    const Vec3<X> v = p - constant<X>(center);
    const X x = dot(v, constant<X>(frame.x)), y = dot(v, constant<X>(frame.y)), z = dot(v, constant<X>(frame.z));
    const X turn = z * X(-angle_per_length);
    const X c = cos(turn), s = sin(turn);
    const X tx = c * x - s * y, ty = s * x + c * y;
    return constant<X>(center) + constant<X>(frame.x) * tx + constant<X>(frame.y) * ty + constant<X>(frame.z) * z;
  }
};

}  // namespace marrow
