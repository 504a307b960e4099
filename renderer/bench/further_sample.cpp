// What one more sample of each pixel costs.
#include "renderer/bench/further_sample.h"

#include "renderer/transport/render.h"

namespace marrow {

TwoRuns sixteen_samples_and_one(const PreparedScene& ready, int threads, StopRequest stop) {
  RenderSettings settings = ready.description.render;
  const auto film = [&](int samples) {
    settings.samples_per_pixel = samples;
    return cost_of(
        [&] { render(ready.render_scene, settings, {.crop = {}, .threads = threads, .interrupted = stop.flag}); });
  };
  const Cost one = film(1);
  return {.shorter = one, .longer = film(16)};
}

}  // namespace marrow
