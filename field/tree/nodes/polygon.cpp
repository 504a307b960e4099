#include "field/tree/nodes/polygon.h"

namespace marrow {

std::string Polygon::problem(std::size_t) const {
  const Placed plane = placed();
  Vec3d area{};
  for (std::size_t i = 0; i < points.size(); ++i)
    area += cross(points[i] - plane.center, points[(i + 1) % points.size()] - plane.center);
  if (!(length(area) > flatness * plane.size * plane.size)) return "the points must span an area";
  for (const Vec3d& p : points)
    if (std::fabs(dot(plane.frame.z, p - plane.center)) > flatness * plane.size)
      return "the points must lie in one plane";
  return "";
}

Box3 Polygon::support() const {
  const Placed plane = placed();
  Box3 flat;
  for (const Vec3d& p : points) {
    const Vec3d v = p - plane.center;
    flat.include(p - plane.frame.z * dot(plane.frame.z, v));
  }
  return reached(flat, 0.5 * thickness + range_of(potential));
}

Polygon::Placed Polygon::placed() const {
  Placed plane;
  for (const Vec3d& p : points) plane.center += p * (1 / static_cast<double>(points.size()));
  Vec3d area{};  // Newell: twice the area vector
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d v = points[i] - plane.center;
    area += cross(v, points[(i + 1) % points.size()] - plane.center);
    plane.size = std::max(plane.size, length(v));
  }
  plane.frame = Frame::around(normalize(area));
  return plane;
}

// A ray along x crosses an odd number of edges.
bool Polygon::inside(double x, double y, const Placed& plane) const {
  bool odd = false;
  Vec3d a = plane.frame.to_local(points.back() - plane.center);
  for (const Vec3d& point : points) {
    const Vec3d b = plane.frame.to_local(point - plane.center);
    if ((a.y > y) != (b.y > y)) {
      const double turn = (b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y);
      if ((turn > 0) == (b.y > a.y)) odd = !odd;
    }
    a = b;
  }
  return odd;
}

}  // namespace marrow
