// Bounds of the derivatives of primitives by distance over a box.
#pragma once

#include <array>
#include <optional>

#include "field/description/field_node.h"
#include "field/math/box3.h"
#include "field/number/interval.h"

namespace marrow {

/// Of one primitive over a box, at kinks of every side.
struct PrimitiveSlopes {
  Vec3<Interval> gradient;
  std::array<Vec3<Interval>, 3> J;  ///< J[i][j] = d S_i / d p_j

  friend bool operator==(const PrimitiveSlopes&, const PrimitiveSlopes&) = default;
};

/// Of k(e), e = min |p - q| / radius(q), from the same places q as distance_field(): an end or a corner, a cone along a
/// line, a plane. All places that may be nearest somewhere in the box count. The least e is unique, so that the place
/// moves without jumps and S has slopes. Nothing where a place is not bounded, or the field is not.
std::optional<PrimitiveSlopes> distance_slopes(const SegmentSkeleton&, const Box3&, const Kernel&);
std::optional<PrimitiveSlopes> distance_slopes(const TriangleSkeleton&, const Box3&, const Kernel&);
/// Along an arc the place may jump: nothing where two that are not beside each other may be nearest.
std::optional<PrimitiveSlopes> distance_slopes(const ArcSkeleton&, const Box3&, const Kernel&);

/// How fast the nearest place of an arc moves, at most: its angle over a length; infinite where it may jump.
double place_speed(const ArcSkeleton&, const Box3&);

}  // namespace marrow
