// A disc or a single direction at infinity.
#pragma once

#include <optional>

#include "materials/sample.h"
#include "renderer/scene/scene_description.h"
#include "renderer/transport/lights/receiver.h"

namespace marrow {

/// A cone of directions of constant radiance L. A facing surface has the irradiance E = pi L sin^2(half angle).
class Sun {
 public:
  explicit Sun(const SunLight&);
  std::optional<LightSample> sample(const Receiver&, Sample2 u) const;
  double pdf(const UnitVec3& wi) const { return inside(wi) ? pdf_ : 0; }
  Rgb escaped(const UnitVec3& direction) const { return inside(direction) ? radiance_ : Rgb{}; }
  bool delta() const { return pdf_ == 0; }
  Rgb irradiance() const { return irradiance_; }

 private:
  bool inside(const UnitVec3& direction) const;

  Frame frame_;
  Rgb irradiance_, radiance_;
  double versine_ = 0;  // 1 - cos(half angle), without cancellation; 0: a single direction
  double pdf_ = 0;
};

}  // namespace marrow
