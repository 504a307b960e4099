#include "renderer/transport/scout.h"

#include <optional>
#include <vector>

namespace marrow {

void send_scouts(const PixelJob& job, const PixelWindow& window, int step) {
  std::vector<Ray> rays;
  std::vector<Sampler> samplers;
  for (int y = window.y0; y < window.y1; y += step)
    for (int x = window.x0; x < window.x1; x += step) {
      rays.push_back(job.scene.camera.ray(x + 0.5, y + 0.5));
      samplers.emplace_back(x, y, job.seed).start(0);
    }
  std::vector<std::optional<SurfaceHit>> hits(rays.size());
  std::vector<Rgb> unused(rays.size());
  job.scene.surfaces->first_hits(rays, hits);
  job.integrator.radiances({rays, hits, samplers}, job.scene, unused);
}

}  // namespace marrow
