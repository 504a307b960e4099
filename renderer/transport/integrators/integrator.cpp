// The light that comes back along a camera ray: the table of ways to find it.
#include "renderer/transport/integrators/integrator.h"

#include "renderer/transport/integrators/diagnostic_views.h"
#include "renderer/transport/integrators/path_tracer.h"

namespace marrow {

std::unique_ptr<const Integrator> make_integrator(const RenderSettings& settings) {
  switch (settings.integrator) {
    case RenderSettings::Integrator::Path:
      return std::make_unique<PathTracer>(settings.max_depth);
    case RenderSettings::Integrator::Direct:
      return std::make_unique<PathTracer>(1);
    case RenderSettings::Integrator::Normals:
      return std::make_unique<NormalView>();
    case RenderSettings::Integrator::Depth:
      return std::make_unique<DepthView>();
  }
  return std::make_unique<PathTracer>(settings.max_depth);
}

}  // namespace marrow
