// Bends space in a plane.
#pragma once

#include <numbers>
#include <string>

#include "field/math/box3.h"
#include "field/number/functions.h"
#include "field/tree/node_info.h"

namespace marrow {

/// The part of the axis within length/2 of `center` becomes an arc of a circle of the same length; what lies before and
/// behind follows rigidly. Where rigid ends would meet behind the centre of the circle, space is cut.   [Barr 1984]
struct Bend {
  static constexpr NodeInfo info{"bend", "Bends its child along an arc of a circle.", 1, 1};
  Vec3d center{};
  UnitVec3 axis = UnitVec3::unchecked({0, 1, 0}), toward = UnitVec3::unchecked({1, 0, 0});
  double length = 1;
  double angle = 0;  ///< radians

  static void keys(auto&& key) {
    key("center", &Bend::center, form::Position{}, "the middle of the part that bends, which stays in place");
    key("axis", &Bend::axis, form::Direction{}, "direction of the line that becomes an arc");
    key("toward", &Bend::toward, form::Direction{}, "where its ends move; its part along the axis does not count");
    key("length", &Bend::length, form::positive, "of the part that bends");
    key("angle", &Bend::angle, form::Angle{.min_deg = 0, .max_deg = 360}, "between the two ends, in degrees");
  }
  std::string problem(std::size_t) const {
    return marrow::length(across()) > 1e-6 ? "" : "toward must not point along the axis";
  }
  Box3 support(const Box3& child) const;

  /// With the arc's centre as origin, the point is at the angle `at`; `bent` is the nearest angle of the arc. Turning
  /// it back by `bent` leaves it where the straight piece was, but for the length of the arc up to there.
  template <Number X>
  Vec3<X> child_point(const Vec3<X>& p) const {
    if (!(radius() < flat * length)) return p;
    const Vec3<X> y = constant<X>(axis), z = constant<X>(normalize(across())), v = p - constant<X>(center);
    const X along = dot(v, y), below = X(radius()) - dot(v, z);
    const X bent = clamp(angle_of(along, below), -angle / 2, angle / 2);
    const X c = cos(bent), s = sin(bent);
    const X straight = X(radius()) * bent + (along * c - below * s), height = X(radius()) - (along * s + below * c);
    return p + y * (straight - along) + z * (height - dot(v, z));
  }

 private:
  // A radius this many lengths long bends by less than 1e-8 degrees.
  static constexpr double flat = 1e10;

  Vec3d across() const { return toward.vec() - axis * dot(axis, toward); }
  double radius() const { return angle > 0 ? length / angle : Box3::inf; }
  /// atan2(y, x), from -pi to pi: twice the angle at the circle's far side.
  template <Number X>
  static X angle_of(const X& y, const X& x) {
    if constexpr (!is_enclosure<X>)
      if (value_of(y) == 0 && !(value_of(x) > 0)) return X(std::numbers::pi);
    const X r = sqrt(square(x) + square(y));
    return piecewise(
        x, 0, [&](const X& behind) { return X(2.0) * atan((r - behind) / y); },
        [&](const X& before) { return X(2.0) * atan(y / (r + before)); });
  }
};

}  // namespace marrow
