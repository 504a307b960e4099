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

  /// With the arc's centre as origin, the point is at the angle `at`. Before and behind the arc, the angle of the arc's
  /// end turns it back to where the straight piece was; in front of the arc that is R at along the axis and R - r over
  /// it, which the same formula gives, but not as tight bounds.
  template <Number X>
  Vec3<X> child_point(const Vec3<X>& p) const {
    if (!(radius() < flat * length)) return p;
    const Vec3<X> y = constant<X>(axis), z = constant<X>(normalize(across())), v = p - constant<X>(center);
    const X along = dot(v, y), height = dot(v, z), below = X(radius()) - height;
    const X at = angle_of(along, below), r = sqrt(square(along) + square(below));
    const X straight = in_three(
        at, [&](double end) { return X(radius() * end) + (along * X(cos(end)) - below * X(sin(end))); },
        [&](const X& between) { return X(radius()) * between; });
    const X over = in_three(
        at, [&](double end) { return X(radius()) - (along * X(sin(end)) + below * X(cos(end))); },
        [&](const X&) { return X(radius()) - r; });
    return p + y * (straight - along) + z * (over - height);
  }

 private:
  // A radius this many lengths long bends by less than 1e-8 degrees.
  static constexpr double flat = 1e10;

  Vec3d across() const { return toward.vec() - axis * dot(axis, toward); }
  double radius() const { return angle > 0 ? length / angle : Box3::inf; }
  template <Number X, class AtEnd, class Between>
  X in_three(const X& at, AtEnd at_end, Between between) const {
    const double half = angle / 2;
    return piecewise(
        at, -half, [&](const X&) { return at_end(-half); },
        [&](const X& rest) { return piecewise(rest, half, between, [&](const X&) { return at_end(half); }); });
  }
  /// atan2(y, x), from -pi to pi: twice the angle at the circle's far side.
  template <Number X>
  static X angle_of(const X& y, const X& x) {
    if constexpr (is_enclosure<X>) {
      return angle_over(y, x);
    } else {
      if (value_of(y) == 0 && !(value_of(x) > 0)) return X(std::numbers::pi);
      const X r = sqrt(square(x) + square(y));
      return value_of(x) < 0 ? X(2.0) * atan((r - x) / y) : X(2.0) * atan(y / (r + x));
    }
  }
  static Interval angle_over(const Interval& y, const Interval& x);
  template <std::size_t N>
  static Jet<Interval, N> angle_over(const Jet<Interval, N>& y, const Jet<Interval, N>& x) {
    Jet<Interval, N> at(angle_over(y.value, x.value));
    const Interval r2 = square(x.value) + square(y.value);
    for (std::size_t i = 0; i < N; ++i)
      at.slope[i] =
          is_cut(y.value, x.value) ? Interval::everything() : (x.value / r2) * y.slope[i] - (y.value / r2) * x.slope[i];
    return at;
  }
  /// Whether the angle jumps within a box.
  static bool is_cut(const Interval& y, const Interval& x) { return y.contains(0) && x.lo <= 0; }
};

}  // namespace marrow
