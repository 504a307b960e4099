// Rays from the eye through points of the film.
#include "renderer/transport/camera/camera.h"

#include <numbers>

#include "field/math/elementary.h"

namespace marrow {

Camera::Camera(const CameraDescription& d, int width, int height)
    : perspective_(d.type == CameraDescription::Type::Perspective),
      origin_(d.from),
      forward_(normalize(d.to - d.from)),
      focus_distance_(length(d.to - d.from)) {
  const UnitVec3 right = normalize(cross(forward_.vec(), d.up));
  const Vec3d up = cross(right.vec(), forward_.vec());
  // Height of the film: at distance 1 for a pinhole, in the scene for parallel rays
  const double film_height = perspective_ ? 2 * tan(d.fov_deg * std::numbers::pi / 360) : d.height;
  const double pixel = film_height / height;
  step_x_ = right * pixel;
  step_y_ = up * -pixel;
  corner_ = step_x_ * (-width / 2.0) + step_y_ * (-height / 2.0);
  if (perspective_) corner_ += forward_.vec();
}

Ray Camera::ray(double film_x, double film_y) const {
  const Vec3d point = corner_ + step_x_ * film_x + step_y_ * film_y;
  if (perspective_) return {.origin = origin_, .direction = normalize(point)};
  return {.origin = origin_ + point, .direction = forward_};
}

}  // namespace marrow
