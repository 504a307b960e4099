// Bends space in a plane.
#pragma once

#include <array>
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
    key("angle", &Bend::angle, form::Angle{}, "between the two ends, in degrees");
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
    const Polar<X> polar(*this, p);
    const X at = angle_of(polar.along, polar.below);
    const X straight = in_three(
        at, [&](double end) { return polar.straight_at_end(end); },
        [&](const X& between) { return X(polar.radius) * between; });
    const X over = in_three(
        at, [&](double end) { return polar.over_at_end(end); }, [&](const X&) { return polar.over_between(); });
    return polar.child(straight, over);
  }

  static constexpr std::size_t most_sides = 4;
  template <class X>
  using Sides = std::array<Vec3<X>, most_sides>;

  /// Over a box that the cut runs through the child is met in several places: behind each end of the arc, and in front
  /// of the arc on either side. Returns their number, or 0 where space is whole. Their hull would hold all of the
  /// child.
  template <Number X>
  std::size_t sides(const Vec3<X>& p, Sides<X>& places) const {
    if constexpr (is_enclosure<X>) {
      if (!(radius() < flat * length)) return 0;
      const Polar<X> polar(*this, p);
      const Interval y = value_of(polar.along), x = value_of(polar.below);
      if (!is_cut(y, x)) return 0;
      const double half = angle / 2, least = least_angle_at_cut(y, x);
      std::size_t count = 0;
      for (const double sign : {-1.0, 1.0}) {
        places[count++] = polar.child(polar.straight_at_end(sign * half), polar.over_at_end(sign * half));
        if (!(least <= half)) continue;
        const X at = any_slope<X>(hull(Interval(sign * least), Interval(sign * half)));
        places[count++] = polar.child(X(polar.radius) * at, polar.over_between());
      }
      return count;
    } else {
      return 0;
    }
  }

 private:
  // A radius this many lengths long bends by less than 1e-8 degrees.
  static constexpr double flat = 1e10;

  // A point in the plane of the arc, seen from its centre, and where parts of that plane come from.
  template <Number X>
  struct Polar {
    double radius;
    Vec3<X> center, x, y, z;
    X aside, along, below;

    Polar(const Bend& bend, const Vec3<X>& p) : radius(bend.radius()), center(constant<X>(bend.center)) {
      const UnitVec3 across = normalize(bend.across());
      x = constant<X>(cross(bend.axis.vec(), across.vec()));
      y = constant<X>(bend.axis);
      z = constant<X>(across);
      const Vec3<X> v = p - center;
      aside = dot(v, x);
      along = dot(v, y);
      below = X(radius) - dot(v, z);
    }
    X straight_at_end(double end) const { return X(radius * end) + (along * X(cos(end)) - below * X(sin(end))); }
    X over_at_end(double end) const { return X(radius) - (along * X(sin(end)) + below * X(cos(end))); }
    X over_between() const { return X(radius) - sqrt(square(along) + square(below)); }
    /// Each coordinate anew, as boxes of p and of what is taken away from it would add up.
    Vec3<X> child(const X& straight, const X& over) const { return center + x * aside + y * straight + z * over; }
  };

  Vec3d across() const { return toward.vec() - axis * dot(axis, toward); }
  double radius() const { return angle > 0 ? length / angle : Box3::inf; }
  template <Number X, class AtEnd, class Between>
  X in_three(const X& at, AtEnd at_end, Between between) const {
    if (angle >= 2 * std::numbers::pi) return between(at);  // behind an end there is nothing
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
      if (value_of(y) == 0 && value_of(x) == 0) return X(std::numbers::pi);
      constexpr double least = 1e-150, up = 1e150;  // squares of less may vanish
      const auto is_small = [](const auto& v) { return v < least && v > -least; };
      if (is_small(value_of(y)) && is_small(value_of(x))) return angle_of(y * X(up), x * X(up));
      const X r = sqrt(square(x) + square(y));
      if (!(value_of(x) < 0)) return X(2.0) * atan(y / (r + x));
      const double far_side = value_of(y) < 0 ? -std::numbers::pi : std::numbers::pi;
      return far_side - 2.0 * atan(y / (r - x));
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
  /// Of |angle|, in a box that the cut runs through.
  static double least_angle_at_cut(const Interval& y, const Interval& x);
  /// Whether the angle jumps within a box.
  static bool is_cut(const Interval& y, const Interval& x) { return y.contains(0) && x.lo <= 0; }
};

}  // namespace marrow
