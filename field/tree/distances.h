// What the signed distances of primitives are made of.
#pragma once

#include "field/number/functions.h"

namespace marrow {

/// A point as seen from an axis: its distance from it (>= 0), and its place along it.
template <Number X>
struct FromAxis {
  X radius, along;
};

/// Each coordinate is one sum, so that boxes across the axis lose nothing but their rotation.
template <Number X>
Vec3<X> local_point(const Vec3<X>& p, const Vec3d& origin, const Frame& frame) {
  const Vec3<X> v = p - origin;
  return {dot(v, frame.x), dot(v, frame.y), dot(v, frame.z)};
}
template <Number X>
FromAxis<X> from_axis(const Vec3<X>& p, const Vec3d& origin, const UnitVec3& axis) {
  const Vec3<X> local = local_point(p, origin, Frame::around(axis));
  return {length(local.x, local.y), local.z};
}

/// Signed distance from a corner where two or three faces meet at right angles, from the distances to the faces.
template <Number X>
X corner_distance(const X& a, const X& b) {
  const X zero(0.0);
  return length(max(a, zero), max(b, zero)) + min(max(a, b), zero);
}
template <Number X>
X corner_distance(const Vec3<X>& q) {
  const X zero(0.0);
  return length(Vec3<X>{max(q.x, zero), max(q.y, zero), max(q.z, zero)}) + min(max(max(q.x, q.y), q.z), zero);
}

/// How far x lies outside of [0, end]; 0 within.
template <Number X>
X excess(const X& x, double end) {
  return max(x - end, X(0.0)) + max(-x, X(0.0));
}

}  // namespace marrow
