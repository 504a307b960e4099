// A rectangle as it is seen from a point, sampled by solid angle.
#include "renderer/transport/lights/spherical_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "field/math/elementary.h"

namespace marrow {

SphericalRectangle::SphericalRectangle(double x0, double x1, double y0, double y1, double z0)
    : x0_(x0), x1_(x1), y0_(y0), y1_(y1), z0_(z0) {
  // The planes through the point and the four edges; neighbours are perpendicular but for their z components, so that
  // the inner angles of the spherical rectangle follow from those alone
  const double n0 = -y0 / std::sqrt(z0 * z0 + y0 * y0), n1 = x1 / std::sqrt(z0 * z0 + x1 * x1);
  const double n2 = y1 / std::sqrt(z0 * z0 + y1 * y1), n3 = -x0 / std::sqrt(z0 * z0 + x0 * x0);
  const double g0 = acos(-n0 * n1), g1 = acos(-n1 * n2), g2 = acos(-n2 * n3), g3 = acos(-n3 * n0);
  b0_ = n0;
  b1_ = n2;
  k_ = 2 * std::numbers::pi - g2 - g3;
  solid_angle_ = g0 + g1 - k_;
}

Sample2 SphericalRectangle::sample(Sample2 u) const {
  // x: the part of the rectangle left of it has the share u.x of the solid angle
  const SinCos angle = sincos(u.x * solid_angle_ + k_);
  const double f = (angle.cos * b0_ - b1_) / angle.sin;
  const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + b0_ * b0_), f), -1.0, 1.0);
  const double x = std::clamp(-c * z0_ / std::sqrt(std::max(1 - c * c, 1e-300)), x0_, x1_);

  // y: uniform in the sine along the arc at that x
  const double d2 = x * x + z0_ * z0_;
  const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
  const double h = h0 + u.y * (h1 - h0);
  const double y = h * std::sqrt(d2 / std::max(1 - h * h, 1e-300));
  return {x, std::clamp(y, y0_, y1_)};
}

}  // namespace marrow
