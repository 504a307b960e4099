// A rectangle that emits from one side.
#pragma once

#include <optional>

#include "field/math/ray.h"
#include "materials/sample.h"
#include "renderer/scene/scene_description.h"
#include "renderer/transport/lights/receiver.h"
#include "renderer/transport/lights/spherical_rectangle.h"

namespace marrow {

/// Emits the same radiance in every direction of the half space of its normal. Its height runs along the scene's up
/// axis as it shows on the rectangle; where the normal is parallel to up, the width runs along x.
class Rectangle {
 public:
  Rectangle(const RectangleLight&, bool z_up);
  std::optional<LightSample> sample(const Receiver&, Sample2 u) const;
  double pdf(const Receiver&, const UnitVec3& wi) const;
  std::optional<LightHit> hit(const Ray&) const;
  double importance(const Vec3d& at) const;

 private:
  // Precondition: the position lies on the emitting side.
  SphericalRectangle seen_from(const Vec3d& position) const;
  double area() const { return 4 * half_width_ * half_height_; }

  Vec3d center_;
  Frame frame_;  // x: width, y: height, z: normal
  double half_width_ = 0, half_height_ = 0;
  Rgb radiance_;
};

}  // namespace marrow
