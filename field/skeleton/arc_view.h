// An arc as seen from a point; internal to skeleton/.
#pragma once

#include <cmath>
#include <numbers>

#include "field/description/field_node.h"
#include "field/math/elementary.h"

namespace marrow {

/// An arc in cylindrical coordinates about its axis: the point lies at (r, angle 0, z), the arc at radius `major`
/// from `begin` to `end`, turned by whole turns so that its middle is nearest to the point.
struct ArcView {
  Vec3d radial, tangential, normal;
  double r, z, begin, end;
  double major;

  /// Of the squared distance, that at angle 0; the rest is 2 r sag(angle).
  double gap() const { return z * z + (r - major) * (r - major); }
  /// From the place on the arc at an angle, given by its half, to the point.
  Vec3d from_arc(const SinCos& half) const {
    const double sag = 2 * major * half.sin * half.sin;  // major (1 - cos angle)
    return radial * (r - major + sag) - tangential * (2 * major * half.sin * half.cos) + normal * z;
  }
};

inline ArcView view_from(const ArcSkeleton& arc, const Vec3d& p) {
  const Vec3d v = p - arc.center;
  const double x = dot(v, arc.axis1), y = dot(v, arc.axis2), r = std::sqrt(x * x + y * y);
  const Vec3d normal = cross(arc.axis1, arc.axis2);
  const Vec3d radial = r > 0 ? (arc.axis1 * x + arc.axis2 * y) / r : arc.axis1;
  const double angle = r > 0 ? atan2(y, x) : 0, turn = 2 * std::numbers::pi;
  const double turns = turn * std::floor(((arc.begin + arc.end) / 2 - angle) / turn + 0.5);
  return {
      radial,   cross(normal, radial), normal, r, dot(v, normal), arc.begin - angle - turns, arc.end - angle - turns,
      arc.major};
}

}  // namespace marrow
