// The places of a primitive by distance that may be nearest to the points of a box; internal to blend/.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "field/blend/bounds/sum/distance_slopes.h"
#include "field/description/field_node.h"
#include "field/math/box3.h"
#include "field/number/interval.h"

namespace marrow::nearest_places {

using Span = Vec3<Interval>;
using Rows = std::array<Span, 3>;
inline constexpr Rows identity{Span{1, 0, 0}, Span{0, 1, 0}, Span{0, 0, 1}};

/// The box seen from a point.
inline Span span_of(const Box3& box, const Vec3d& from) {
  Span v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = Interval(box.lower[i], box.upper[i]) - Interval(from[i]);
  return v;
}
inline Interval along(const Span& v, const Vec3d& u) { return v.x * u.x + v.y * u.y + v.z * u.z; }
inline Span times(const Vec3d& u, const Interval& t) { return {t * u.x, t * u.y, t * u.z}; }
inline Interval squared_length(const Span& v) { return square(v.x) + square(v.y) + square(v.z); }

/// A place q that may be the nearest one, seen from the points of a box.
struct Place {
  Span to_point;  ///< p - q
  Interval radius;
  Rows turns;    ///< the Jacobian of p - q, less (p - q) by that of ln radius
  bool is_real;  ///< for every point a place of the skeleton, though it may not be the nearest one

  Interval scaled_squared() const { return squared_length(to_point) / square(radius); }
};

/// The few places of one skeleton.
class Places {
 public:
  void add(const Place& p) { all_[count_++] = p; }
  /// A place is out where another is nearer all over the box. Nothing where one may be met, or its radius vanish.
  std::optional<PrimitiveSlopes> slopes(const Kernel&) const;

 private:
  std::array<Place, 10> all_;
  std::size_t count_ = 0;
};

}  // namespace marrow::nearest_places
