// Pictures of geometry alone: normals and depth as colours.
#pragma once

#include "renderer/transport/integrators/integrator.h"

namespace marrow {

class NormalView final : public Integrator {
 public:
  Rgb radiance(const Ray&, const std::optional<SurfaceHit>& first, const RenderScene&, Sampler&) const override {
    if (!first) return {};
    const Vec3d n = first->normal;
    return Rgb(n.x + 1, n.y + 1, n.z + 1) / 2;
  }
  bool noise_free() const override { return true; }
};

class DepthView final : public Integrator {
 public:
  Rgb radiance(const Ray&, const std::optional<SurfaceHit>& first, const RenderScene& scene, Sampler&) const override {
    if (!first) return {};
    const double focus = scene.camera.focus_distance();
    return Rgb(focus / (focus + std::max(scene.camera.depth(first->position), 0.0)));
  }
  bool noise_free() const override { return true; }
};

}  // namespace marrow
