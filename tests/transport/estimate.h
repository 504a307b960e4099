// Means of Monte Carlo estimates with their standard error.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/transport/integrators/integrator.h"

namespace marrow {

struct Estimate {
  double mean = 0, standard_error = 0;
};

/// Mean of `sample(sampler)` in 64 independent batches of `batch` samples; the error is that of the batch means.
template <class F>
Estimate estimate(int batch, F sample) {
  constexpr int batches = 64;
  double sum = 0, squares = 0;
  for (int b = 0; b < batches; ++b) {
    Sampler sampler(b, 7, 1);
    double mean = 0;
    for (int i = 0; i < batch; ++i) {
      sampler.start(static_cast<std::uint32_t>(i));
      mean += sample(sampler) / batch;
    }
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / batches;
  const double variance = std::max(squares / batches - mean * mean, 0.0) / (batches - 1);
  return {mean, std::sqrt(variance)};
}

/// Green radiance along a ray.
inline Estimate radiance(const Integrator& integrator, const RenderScene& scene, const Ray& ray, int batch) {
  const auto first = scene.surfaces->first_hit(ray);
  return estimate(batch, [&](Sampler& sampler) { return integrator.radiance(ray, first, scene, sampler).g; });
}

/// A scene of one look at the origin, without a film.
inline RenderScene scene_of(const Surfaces& surfaces, std::vector<Material> materials, std::vector<Light> lights) {
  const bool has_emission = std::ranges::any_of(materials, &Material::emits);
  return {.surfaces = &surfaces,
          .materials = std::move(materials),
          .has_emission = has_emission,
          .lights = LightSet(std::move(lights), {}),
          .camera = {},
          .width = 0,
          .height = 0};
}

inline Ray ray_to(const Vec3d& from, const Vec3d& to) { return {.origin = from, .direction = normalize(to - from)}; }

inline Material diffuse(double albedo) { return Material(Bsdf(Diffuse(Rgb(albedo)))); }

}  // namespace marrow
