// How large skeletons are, and how they are cut into equal parts of the same kind.
#pragma once

#include <algorithm>
#include <array>

#include "field/description/field_node.h"
#include "field/math/elementary.h"

namespace marrow {

inline std::array<SegmentSkeleton, 2> parts(const SegmentSkeleton& s) {
  const Vec3d middle = lerp(s.from, s.to, 0.5);
  const double radius = 0.5 * (s.radius_from + s.radius_to);
  return {SegmentSkeleton{s.from, middle, s.radius_from, radius}, SegmentSkeleton{middle, s.to, radius, s.radius_to}};
}

inline std::array<ArcSkeleton, 2> parts(const ArcSkeleton& s) {
  ArcSkeleton a = s, b = s;
  a.end = b.begin = 0.5 * (s.begin + s.end);
  a.radius_to = b.radius_from = 0.5 * (s.radius_from + s.radius_to);
  return {a, b};
}

inline std::array<TriangleSkeleton, 4> parts(const TriangleSkeleton& s) {
  const auto& v = s.vertices;
  const auto& r = s.radii;
  const Vec3d ab = lerp(v[0], v[1], 0.5), bc = lerp(v[1], v[2], 0.5), ca = lerp(v[2], v[0], 0.5);
  const double rab = 0.5 * (r[0] + r[1]), rbc = 0.5 * (r[1] + r[2]), rca = 0.5 * (r[2] + r[0]);
  return {TriangleSkeleton{{v[0], ab, ca}, {r[0], rab, rca}}, TriangleSkeleton{{ab, v[1], bc}, {rab, r[1], rbc}},
          TriangleSkeleton{{ca, bc, v[2]}, {rca, rbc, r[2]}}, TriangleSkeleton{{bc, ca, ab}, {rbc, rca, rab}}};
}

constexpr int dimension_of(const PointSkeleton&) { return 0; }
constexpr int dimension_of(const SegmentSkeleton&) { return 1; }
constexpr int dimension_of(const ArcSkeleton&) { return 1; }
constexpr int dimension_of(const TriangleSkeleton&) { return 2; }

/// Length or area.
inline double measure(const SegmentSkeleton& s) { return length(s.to - s.from); }
inline double measure(const ArcSkeleton& s) { return s.major * (s.end - s.begin); }
inline double measure(const TriangleSkeleton& s) {
  return 0.5 * length(cross(s.vertices[1] - s.vertices[0], s.vertices[2] - s.vertices[0]));
}

/// The length, or the longest side.
inline double extent(const TriangleSkeleton& s) {
  const auto& v = s.vertices;
  return std::max({length(v[1] - v[0]), length(v[2] - v[1]), length(v[0] - v[2])});
}
inline double extent(const auto& s) { return measure(s); }

inline Vec3d place_at(const ArcSkeleton& s, double angle) {
  const auto [sine, cosine] = sincos(angle);
  return s.center + s.axis1 * (s.major * cosine) + s.axis2 * (s.major * sine);
}

}  // namespace marrow
