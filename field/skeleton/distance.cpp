#include "field/skeleton/distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/math/box3.h"
#include "field/math/elementary.h"
#include "field/skeleton/parts.h"

namespace marrow {

double distance_to(const PointSkeleton& s, const Vec3d& p) { return length(p - s.at); }

double distance_to(const SegmentSkeleton& s, const Vec3d& p) {
  const Vec3d along = s.to - s.from, w = p - s.from;
  const double length2 = length_squared(along);
  const double t = length2 > 0 ? std::clamp(dot(w, along) / length2, 0.0, 1.0) : 0;
  return length(w - along * t);
}

// The foot of p in the plane when it falls inside, else the nearest edge.
double distance_to(const TriangleSkeleton& s, const Vec3d& p) {
  const auto& v = s.vertices;
  const Vec3d normal = cross(v[1] - v[0], v[2] - v[0]);
  double nearest = Box3::inf;
  bool is_over = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d& a = v[i];
    const Vec3d& b = v[(i + 1) % 3];
    if (dot(cross(b - a, p - a), normal) < 0) is_over = false;
    nearest = std::min(nearest, distance_to(SegmentSkeleton{.from = a, .to = b}, p));
  }
  return is_over ? std::fabs(dot(normalize(normal), p - v[0])) : nearest;
}

// That of its circle where p stands at one of its angles, else that of the nearer end.
double distance_to(const ArcSkeleton& s, const Vec3d& p) {
  const Vec3d w = p - s.center;
  const double x = dot(s.axis1, w), y = dot(s.axis2, w), turn = 2 * std::numbers::pi;
  const double turns = (atan2(y, x) - 0.5 * (s.begin + s.end)) / turn, from_middle = turns - std::floor(turns + 0.5);
  if (std::fabs(from_middle) * turn > 0.5 * (s.end - s.begin))
    return std::min(length(p - place_at(s, s.begin)), length(p - place_at(s, s.end)));
  const double across = std::sqrt(x * x + y * y) - s.major, height = dot(cross(s.axis1, s.axis2), w);
  return std::sqrt(across * across + height * height);
}

}  // namespace marrow
