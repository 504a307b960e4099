// A scene file made ready to be traced and rendered.
#include "renderer/bench/prepared_scene.h"

#include <utility>

#include "renderer/bench/cost.h"
#include "renderer/geometry/build_surfaces.h"
#include "renderer/scene/read_scene.h"

namespace marrow {

Result<PreparedScene> prepare_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                                    int threads) {
  const double start = cost_so_far().wall_s;
  const auto elapsed = [start] { return cost_so_far().wall_s - start; };
  auto description = read_scene(path, ReadOptions{.overrides = overrides});
  if (!description) return description.why();
  PreparedScene ready;
  ready.description = std::move(*description);
  ready.read_s = elapsed();
  auto surfaces = build_surfaces(
      ready.description, {.isa = {}, .threads = threads, .samples = ready.description.render.samples_per_pixel});
  if (!surfaces) return surfaces.why();
  ready.surfaces = std::move(*surfaces);
  ready.build_s = elapsed() - ready.read_s;
  const Vec3d eye = ready.description.camera.from;
  ready.surfaces->first_hit({eye, normalize(ready.surfaces->bounds().center() - eye)});
  ready.first_ray_s = elapsed();
  auto compiled = compile_transport(ready.description, *ready.surfaces, [](const auto&) -> Result<EnvironmentImage> {
    return failure("workloads have no image lights");
  });
  if (!compiled) return compiled.why();
  ready.render_scene = std::move(*compiled);
  return ready;
}

}  // namespace marrow
