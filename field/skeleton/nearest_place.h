// The place of a skeleton with the smallest scaled distance; internal to skeleton/.
#pragma once

#include "field/description/field_node.h"
#include "field/math/matrix3.h"
#include "field/skeleton/shares.h"

namespace marrow {

struct NearestPlace {
  Vec3d to_point;  ///< p less the place, which loses nothing however far both are from the origin
  double radius;
  Matrix3 moves{};  ///< Jacobian of the place by p; 0 at ends and corners, where it stays
  Shares shares{};  ///< where it is, as of shares.h but not weighted

  bool is_fixed() const { return moves == Matrix3{}; }
};
NearestPlace nearest_place(const SegmentSkeleton&, const Vec3d& p);
NearestPlace nearest_place(const TriangleSkeleton&, const Vec3d& p);
NearestPlace nearest_place(const ArcSkeleton&, const Vec3d& p);

}  // namespace marrow
