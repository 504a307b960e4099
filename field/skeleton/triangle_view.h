// A triangle as seen from a point, as a bundle of lines parallel to an edge; internal to skeleton/.
#pragma once

#include <cmath>
#include <cstddef>

#include "field/description/field_node.h"
#include "field/kernel/panels.h"
#include "field/kernel/segment_moments.h"

namespace marrow {

/// A triangle seen from a point with one of its edges as base: u along the base, w in the plane toward the apex.
struct TriangleView {
  UnitVec3 u, w, normal;
  double base, apex_u, apex_w;  // the base from (0, 0) to (base, 0)
  double p_u, p_w, p_normal;    // the point
  double radius_begin, radius_end, radius_apex;
};

inline TriangleView view_from(const TriangleSkeleton& t, const Vec3d& p, std::size_t edge) {
  const std::size_t next = (edge + 1) % 3, apex = (edge + 2) % 3;
  const Vec3d along = t.vertices[next] - t.vertices[edge], side = t.vertices[apex] - t.vertices[edge];
  const double base = length(along);
  const UnitVec3 u = UnitVec3::unchecked(along / base);
  const double apex_u = dot(side, u);
  const Vec3d up = side - u * apex_u;
  const double apex_w = length(up);
  const UnitVec3 w = UnitVec3::unchecked(up / apex_w), normal = UnitVec3::unchecked(cross(u.vec(), w.vec()));
  const Vec3d v = p - t.vertices[edge];
  return {u,         w,         normal,         base,          apex_u,        apex_w,
          dot(v, u), dot(v, w), dot(v, normal), t.radii[edge], t.radii[next], t.radii[apex]};
}

/// The edge beyond which the foot of p lies farthest, so that the line through the foot misses the triangle;
/// for a foot inside the longest edge, with the widest angles at its ends.
inline TriangleView best_view(const TriangleSkeleton& t, const Vec3d& p, bool& foot_is_inside) {
  TriangleView outermost{}, longest{};
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const TriangleView view = view_from(t, p, edge);
    if (edge == 0 || view.p_w < outermost.p_w) outermost = view;
    if (edge == 0 || view.base > longest.base) longest = view;
  }
  foot_is_inside = outermost.p_w >= 0;
  return foot_is_inside ? longest : outermost;
}

/// The line at height x over that of the foot.
inline SegmentView line_at(const TriangleView& v, double x) {
  const double share = (x + v.p_w) / v.apex_w;
  SegmentView line;
  line.t1 = v.apex_u * share - v.p_u;
  line.t2 = v.base + (v.apex_u - v.base) * share - v.p_u;
  line.h_squared = x * x + v.p_normal * v.p_normal;
  line.slope = (v.radius_end - v.radius_begin) / v.base;
  line.radius1 = v.radius_begin + (v.radius_apex - v.radius_begin) * share;
  line.radius_at_foot = line.radius1 - line.slope * line.t1;
  return line;
}

/// Where, over complex x = w - p_w, an end of the line (a side of the triangle from (begin, 0)) has no distance to p.
inline Singularity of_side(const TriangleView& v, double begin) {
  const double along_u = (v.apex_u - begin) / v.apex_w;  // the side is (begin + along_u w, w)
  const double side_squared = along_u * along_u + 1, from_u = begin - v.p_u, from_w = -v.p_w;
  const double at = -(from_u * along_u + from_w) / side_squared;
  const double in_plane = (from_u - from_w * along_u) / side_squared;
  return {at - v.p_w, std::sqrt(in_plane * in_plane + v.p_normal * v.p_normal / side_squared)};
}

}  // namespace marrow
