// Rays from the eye through points of the film.
#pragma once

#include "field/math/ray.h"
#include "renderer/scene/scene_description.h"

namespace marrow {

/// Pinhole or orthographic. Film coordinates are pixels: (0, 0) is the upper left corner of the film, pixel (x, y) has
/// its middle at (x + 0.5, y + 0.5), y counts downward.
class Camera {
 public:
  Camera() = default;
  /// Precondition: from != to, up is not parallel to to - from, width and height > 0.
  Camera(const CameraDescription&, int width, int height);

  Ray ray(double film_x, double film_y) const;
  /// Distance of a point from the camera along its axis.
  double depth(const Vec3d& point) const { return dot(point - origin_, forward_); }
  /// Distance from `from` to `to`.
  double focus_distance() const { return focus_distance_; }

 private:
  bool perspective_ = true;
  Vec3d origin_;
  UnitVec3 forward_;
  Vec3d corner_;           // of film point (0, 0): direction (perspective) or offset from the origin (orthographic)
  Vec3d step_x_, step_y_;  // of one pixel to the right, and down
  double focus_distance_ = 1;
};

}  // namespace marrow
