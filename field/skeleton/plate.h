// A triangle as seen from the foot of a point in its plane; internal to skeleton/.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "field/description/field_node.h"
#include "field/kernel/panels.h"

namespace marrow {

/// Lengths and radii over the largest radius of the triangle, places in the plane from the foot of the point.
struct Plate {
  struct Side {
    Vec3d along, out;   ///< unit vectors in the plane; `out` away from the triangle
    double t1, t2;      ///< its ends along its line, from the foot on that line
    double inside;      ///< how far the foot is from the line, on the side of the triangle
    double tau1, tau2;  ///< the radii at its ends

    double radius_at(double t) const { return tau1 + (tau2 - tau1) * ((t - t1) / (t2 - t1)); }
  };
  double unit = 1;    ///< the largest radius
  Vec3d normal;       ///< a unit vector
  double height = 0;  ///< of the point, along the normal
  std::array<Side, 3> sides;
  Vec3d taper;             ///< the gradient of the radius in the plane
  double tau_at_foot = 1;  ///< may be <= 0 when the foot is outside
  double narrowest = 0;    ///< the least height of a corner over its opposite side
  double beside = 0;       ///< from the foot to the triangle, 0 in it

  bool is_even() const { return taper == Vec3d{}; }
  /// In polar coordinates about the foot integrals over the distance from it begin at the height h of the point, and
  /// give a constant h^-q less d^-q on the border. Where the foot is outside, the constant adds up to nothing over all
  /// sides and may be left out; near by it is no more than 1.25^(q/2) of d^-q at the nearest place, and may stay.
  bool counts_from_foot() const { return 2 * beside <= std::fabs(height); }
  /// Calls visit(t, weight) for the nodes of a side, for integrands of powers of the distance, with a polynomial factor
  /// of this degree, and, unless it counts from the foot, over the square of the distance from the foot.
  template <class Visit>
  void for_each_node_of(const Side& s, int polynomial_degree, const Visit& visit) const {
    const Singularity pole{0,
                           counts_from_foot() ? std::sqrt(s.inside * s.inside + height * height) : std::fabs(s.inside)};
    for_each_panel(s.t1, s.t2, {&pole, 1}, s.t2 - s.t1,
                   [&](const Panel& panel) { for_each_node(panel, polynomial_degree, visit); });
  }
};

/// Nothing for a triangle without area.
std::optional<Plate> plate_seen_from(const TriangleSkeleton&, const Vec3d& p);

}  // namespace marrow
