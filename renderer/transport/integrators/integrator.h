// The light that comes back along a camera ray.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "renderer/transport/render_scene.h"
#include "renderer/transport/sampling/sobol.h"

namespace marrow {

/// Camera samples of neighbouring pixels: as many rays as hits and samplers.
struct CameraSamples {
  std::span<const Ray> rays;
  std::span<const std::optional<SurfaceHit>> first;  ///< the rays' nearest surfaces
  std::span<Sampler> samplers;
};

/// An open set, called for every camera sample. Safe to call from many threads.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Radiance arriving along `ray`, whose nearest surface is `first`.
  virtual Rgb radiance(const Ray& ray, const std::optional<SurfaceHit>& first, const RenderScene&, Sampler&) const = 0;
  /// The same for several samples, to the same bits.
  virtual void radiances(const CameraSamples& of, const RenderScene& scene, std::span<Rgb> radiances) const {
    for (std::size_t i = 0; i < of.rays.size(); ++i)
      radiances[i] = radiance(of.rays[i], of.first[i], scene, of.samplers[i]);
  }
  /// One sample through each pixel's middle says it all.
  virtual bool noise_free() const { return false; }
};

/// path: path tracing. direct: the same with one scattering.
/// normals: (n + 1) / 2 for the normal n, black where there is nothing.
/// depth: f / (f + Z) for the depth Z and the camera's focus distance f = |to - from|: 1 at the camera, 1/2 at `to`, 0
/// where there is nothing.
std::unique_ptr<const Integrator> make_integrator(const RenderSettings&);

}  // namespace marrow
