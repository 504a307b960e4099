// All lights of a scene, and which of them to ask.
#include "renderer/transport/lights/light_set.h"

#include <algorithm>

namespace marrow {

LightSet::LightSet(std::vector<Light> lights, const Vec3d& middle) : lights_(std::move(lights)) {
  double total = 0;
  for (const Light& light : lights_) {
    probabilities_.push_back(light.importance(middle));
    total += probabilities_.back();
  }
  const double equal = 1.0 / static_cast<double>(lights_.size());
  for (double& p : probabilities_) p = total > 0 && std::isfinite(total) ? (p / total + equal) / 2 : equal;
  can_be_met_ = std::ranges::any_of(lights_, &Light::can_be_met);
}

LightSet::Pick LightSet::pick(double u) const {
  std::size_t i = 0;
  while (i + 1 < lights_.size() && u >= probabilities_[i]) u -= probabilities_[i++];
  return {&lights_[i], probabilities_[i]};
}

bool LightSet::finite_light_on(const Ray& ray) const {
  return std::ranges::any_of(lights_, [&](const Light& light) { return light.hit(ray).has_value(); });
}

}  // namespace marrow
