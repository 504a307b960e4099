// A flat polygon, thickened.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "field/tree/distances.h"
#include "field/tree/extent.h"
#include "field/tree/potential.h"

namespace marrow {

/// All within half a thickness of a polygon, which may have dents; where it crosses itself, what lies inside an odd
/// number of its turns counts. The distance is exact outside, and inside but near dents. Points are taken to the plane
/// through their mean across Newell's normal.
struct Polygon {
  static constexpr NodeInfo info{"polygon", "A flat polygon, thickened, with round edges and a bounded field."};
  /// Of the polygon's size: how far points may lie off the plane, and nearer than what an edge is not told from a
  /// point.
  static constexpr double flatness = 1e-6, edge_width = 1e-12;
  std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  double thickness = 0.2;
  Potential potential;

  static void keys(auto&& key) {
    key("points", &Polygon::points, form::Points{.min_count = 3}, "its corners in order, in one plane");
    key("thickness", &Polygon::thickness, form::positive, "from face to face");
    key("potential", &Polygon::potential, form::OneOf{}, "how the field falls");
  }
  std::string problem(std::size_t) const;
  Box3 support() const;

  template <Number X>
  X value(const Vec3<X>& p) const {
    const Placed plane = placed();
    const Vec3<X> local = local_point(p, plane.center, plane.frame);
    const X beside = outside_distance(local.x, local.y, plane);
    return bounded_field(potential, length(beside, local.z) - 0.5 * thickness);
  }

 private:
  struct Placed {
    Vec3d center;
    Frame frame;
    double size = 0;  // largest distance from the centre
  };
  Placed placed() const;
  bool inside(double x, double y, const Placed&) const;

  /// Distance in the plane, 0 inside.
  template <Number X>
  X outside_distance(const X& x, const X& y, const Placed& plane) const {
    X edge(Box3::inf);
    Vec3d a = plane.frame.to_local(points.back() - plane.center);
    for (const Vec3d& point : points) {
      const Vec3d b = plane.frame.to_local(point - plane.center);
      edge = min(edge, edge_distance(x, y, a, b));
      a = b;
    }
    // No edge passes between two points of one enclosure that lies clear of all edges, so that one stands for all.
    if (is_enclosure<X> && lower(edge) <= edge_width * plane.size) return hull_with_zero(edge);
    const bool within = inside(0.5 * (lower(x) + upper(x)), 0.5 * (lower(y) + upper(y)), plane);
    return within ? X(0.0) : edge;
  }
  template <Number X>
  static X hull_with_zero(const X& edge) {
    if constexpr (is_enclosure<X>) return hull(edge, X(0.0));
    else return edge;
  }
  template <Number X>
  static X edge_distance(const X& x, const X& y, const Vec3d& a, const Vec3d& b) {
    const double dx = b.x - a.x, dy = b.y - a.y, side = std::sqrt(dx * dx + dy * dy);
    if (!(side > 0)) return length(x - a.x, y - a.y);
    const double ex = dx / side, ey = dy / side;
    const X u = x - a.x, v = y - a.y;
    return length(u * ey - v * ex, excess(u * ex + v * ey, side));
  }
};

}  // namespace marrow
