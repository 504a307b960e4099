// Light from an image of all directions, sampled by its brightness.
#pragma once

#include <memory>
#include <optional>

#include "materials/sample.h"
#include "renderer/scene/scene_description.h"
#include "renderer/transport/lights/environment_image.h"
#include "renderer/transport/lights/receiver.h"

namespace marrow {

/// Radiance is interpolated linearly between pixel middles. Directions are drawn from a density that is constant on
/// each pixel and proportional to the mean luminance there times the pixel's solid angle.
class Environment {
 public:
  /// `rotate_deg` turns the image counter-clockwise about up, seen from above.
  Environment(EnvironmentImage image, Rgb scale, double rotate_deg, bool z_up);
  std::optional<LightSample> sample(Sample2 u) const;
  double pdf(const UnitVec3& wi) const;
  Rgb escaped(const UnitVec3& direction) const;
  /// Mean radiance over all directions.
  Rgb mean() const;

 private:
  struct Tables;
  std::shared_ptr<const Tables> tables_;
};

}  // namespace marrow
