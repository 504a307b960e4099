// A disc or a single direction at infinity.
#include "renderer/transport/lights/sun.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "field/math/elementary.h"

namespace marrow {

Sun::Sun(const SunLight& d) : frame_(Frame::around(normalize(d.direction))), irradiance_(d.irradiance) {
  const double half_angle = std::clamp(d.angle_deg, 0.0, 180.0) * std::numbers::pi / 360;
  if (half_angle == 0) return;
  const double s = sin(half_angle / 2);
  versine_ = 2 * s * s;
  radiance_ = irradiance_ / (std::numbers::pi * versine_ * (2 - versine_));  // sin^2 = versine (2 - versine)
  pdf_ = 1 / (2 * std::numbers::pi * versine_);
}

bool Sun::inside(const UnitVec3& direction) const {
  return length_squared(direction.vec() - frame_.z.vec()) <= 2 * versine_;  // |a - b|^2 = 2 (1 - cos)
}

std::optional<LightSample> Sun::sample(const Receiver& at, Sample2 u) const {
  constexpr double far = std::numeric_limits<double>::infinity();
  if (delta()) {
    if (!(dot(at.normal, frame_.z) > 0)) return std::nullopt;
    return LightSample{.wi = frame_.z, .radiance = irradiance_, .distance = far, .pdf = 1, .delta = true};
  }
  const double versine = u.x * versine_, radius = std::sqrt(versine * (2 - versine));
  const SinCos phi = sincos(2 * std::numbers::pi * u.y);
  const Vec3d wi = frame_.to_world({radius * phi.cos, radius * phi.sin, 1 - versine});
  if (!(dot(at.normal, wi) > 0)) return std::nullopt;
  return LightSample{
      .wi = UnitVec3::unchecked(wi), .radiance = radiance_, .distance = far, .pdf = pdf_, .delta = false};
}

}  // namespace marrow
