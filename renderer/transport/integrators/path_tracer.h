// Path tracing with next-event estimation.
#pragma once

#include "renderer/transport/integrators/integrator.h"

namespace marrow {

/// At each surface one light is asked and one direction is drawn from the surface's own density; the two estimates are
/// weighted by the power heuristic. From the fourth surface on paths end at random by their throughput, without bias.
/// [Kajiya 1986; Veach 1997, ch. 9; Arvo & Kirk 1990]
class PathTracer final : public Integrator {
 public:
  /// Which of the two estimates to take. All have the same mean; the single ones are for tests.
  enum class Strategy { Both, LightsOnly, SurfacesOnly };

  /// max_depth: surfaces along a path that may scatter; 1 is direct light only.
  explicit PathTracer(int max_depth, Strategy strategy = Strategy::Both) : max_depth_(max_depth), strategy_(strategy) {}
  Rgb radiance(const Ray&, const std::optional<SurfaceHit>& first, const RenderScene&, Sampler&) const override;
  /// The rays of all paths go together, surface by surface.
  void radiances(const CameraSamples&, const RenderScene&, std::span<Rgb>) const override;

 private:
  int max_depth_;
  Strategy strategy_;
};

}  // namespace marrow
