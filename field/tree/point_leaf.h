// A lone point: the leaf that wide trees have most of.
#pragma once

#include "field/math/box3.h"
#include "field/math/elementary.h"
#include "field/number/functions.h"
#include "field/tree/extent.h"

namespace marrow {

/// (radius / distance)^3, the field of a blend of one point with the inverse kernel of degree 4, which its correction
/// leaves as it is: a point alone lies on the reference curve. Infinite in the point itself.
struct PointLeaf {
  Vec3d at;
  double radius = 1;

  Box3 support() const { return {{-Box3::inf, -Box3::inf, -Box3::inf}, {Box3::inf, Box3::inf, Box3::inf}}; }
  Box3 extent(double level) const { return reached({at, at}, radius * pow(level, -1.0 / 3) * (1 + 1e-12)); }

  template <Number X>
  X value(const Vec3<X>& p) const {
    const Vec3<X> d = (p - constant<X>(at)) * X(1 / radius);
    const X e = square(d.x) + square(d.y) + square(d.z);
    if (!(upper(e) > 0)) return X(Box3::inf);
    const X q = X(1.0) / e;
    return q * sqrt(q);
  }
};

}  // namespace marrow
