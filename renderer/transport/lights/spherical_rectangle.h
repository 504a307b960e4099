// A rectangle as it is seen from a point, sampled by solid angle.
#pragma once

#include "materials/sample.h"

namespace marrow {

/// In coordinates around the point, axes along the rectangle's: it spans [x0, x1] x [y0, y1] in the plane z = z0 < 0.
/// [Urena, Fajardo, King 2013, "An area-preserving parametrization for spherical rectangles"]
class SphericalRectangle {
 public:
  SphericalRectangle(double x0, double x1, double y0, double y1, double z0);
  double solid_angle() const { return solid_angle_; }
  /// Coordinates x and y of a point of the rectangle, uniform in solid angle. Exact to about 1e-15 / solid_angle().
  Sample2 sample(Sample2 u) const;

 private:
  double x0_, x1_, y0_, y1_, z0_;
  double b0_, b1_;  // heights of the normals of the lower and upper edge's planes
  double k_;        // where the angle of integration starts
  double solid_angle_;
};

}  // namespace marrow
