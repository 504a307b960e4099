// A rectangle that emits from one side.
#include "renderer/transport/lights/rectangle.h"

#include <algorithm>
#include <numbers>

namespace marrow {
namespace {

// A rectangle that looks smaller is sampled by area, which is then as good; the spherical formulas lose digits there.
constexpr double smallest_solid_angle = 1e-3;

Frame oriented(const UnitVec3& normal, const Vec3d& up) {
  const Vec3d across = cross(up, normal.vec());
  const UnitVec3 width = length_squared(across) > 1e-12 ? normalize(across) : UnitVec3::unchecked({1, 0, 0});
  return {width, UnitVec3::unchecked(cross(normal.vec(), width.vec())), normal};
}

}  // namespace

Rectangle::Rectangle(const RectangleLight& d, bool z_up)
    : center_(d.center),
      frame_(oriented(normalize(d.normal), z_up ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0})),
      half_width_(d.width / 2),
      half_height_(d.height / 2),
      radiance_(d.radiance) {}

SphericalRectangle Rectangle::seen_from(const Vec3d& position) const {
  const Vec3d c = frame_.to_local(center_ - position);
  return {c.x - half_width_, c.x + half_width_, c.y - half_height_, c.y + half_height_, c.z};
}

std::optional<LightSample> Rectangle::sample(const Receiver& at, Sample2 u) const {
  const double height = dot(frame_.z, at.position - center_);
  if (!(height > 0)) return std::nullopt;
  const SphericalRectangle seen = seen_from(at.position);
  const bool near = seen.solid_angle() > smallest_solid_angle;
  const Vec3d center = frame_.to_local(center_ - at.position);
  const Sample2 p =
      near ? seen.sample(u) : Sample2{center.x + (2 * u.x - 1) * half_width_, center.y + (2 * u.y - 1) * half_height_};
  const Vec3d to_light = frame_.to_world({p.x, p.y, -height});
  const double distance2 = length_squared(to_light), distance = std::sqrt(distance2);
  if (!(dot(at.normal, to_light) > 0)) return std::nullopt;
  return LightSample{.wi = UnitVec3::unchecked(to_light / distance),
                     .radiance = radiance_,
                     .distance = distance,
                     .pdf = near ? 1 / seen.solid_angle() : distance2 * distance / (height * area()),
                     .delta = false};
}

double Rectangle::pdf(const Receiver& at, const UnitVec3& wi) const {
  const auto met = hit({.origin = at.position, .direction = wi});
  if (!met) return 0;
  const double solid_angle = seen_from(at.position).solid_angle();
  if (solid_angle > smallest_solid_angle) return 1 / solid_angle;
  return met->t * met->t / (-dot(frame_.z, wi) * area());
}

std::optional<LightHit> Rectangle::hit(const Ray& ray) const {
  const double cosine = -dot(frame_.z, ray.direction);
  if (!(cosine > 0)) return std::nullopt;
  const double t = dot(frame_.z, ray.origin - center_) / cosine;
  if (!(t > ray.t_min) || t > ray.t_max) return std::nullopt;
  const Vec3d p = ray.at(t) - center_;
  if (std::fabs(dot(frame_.x, p)) > half_width_ || std::fabs(dot(frame_.y, p)) > half_height_) return std::nullopt;
  return LightHit{.t = t, .radiance = radiance_};
}

double Rectangle::importance(const Vec3d& at) const {
  // L A / d^2 far away; never more than a whole hemisphere of it
  return luminance(radiance_) * std::min(area() / std::max(length_squared(at - center_), 1e-300), std::numbers::pi);
}

}  // namespace marrow
