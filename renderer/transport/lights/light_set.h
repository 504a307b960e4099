// All lights of a scene, and which of them to ask.
#pragma once

#include <vector>

#include "renderer/transport/lights/light.h"

namespace marrow {

/// Lights are picked with fixed probabilities: half of it shared equally, half by the irradiance that each can give at
/// the middle of the scene.
class LightSet {
 public:
  LightSet() = default;
  LightSet(std::vector<Light> lights, const Vec3d& middle);

  struct Pick {
    const Light* light;
    double probability;
  };
  /// Precondition: not empty. `u` in [0, 1).
  Pick pick(double u) const;

  bool empty() const { return lights_.empty(); }
  std::size_t size() const { return lights_.size(); }
  const Light& operator[](std::size_t i) const { return lights_[i]; }
  double probability(std::size_t i) const { return probabilities_[i]; }
  /// Whether a ray can meet any of them.
  bool can_be_met() const { return can_be_met_; }
  /// Whether the ray meets a light of finite distance.
  bool finite_light_on(const Ray&) const;

 private:
  std::vector<Light> lights_;
  std::vector<double> probabilities_;
  bool can_be_met_ = false;
};

}  // namespace marrow
