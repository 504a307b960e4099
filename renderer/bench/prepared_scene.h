// A scene file made ready to be traced and rendered, with the time it took.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "renderer/geometry/surfaces.h"
#include "renderer/scene/scene_description.h"
#include "renderer/transport/render_scene.h"

namespace marrow {

struct PreparedScene {
  SceneDescription description;
  std::unique_ptr<Surfaces> surfaces;
  RenderScene render_scene;
  double read_s = 0, build_s = 0;  ///< wall time
  double first_ray_s = 0;          ///< from the file to the answer of a ray to the scene's middle
};

/// `overrides` as in ReadOptions. Errors: whatever is wrong with the scene.
Result<PreparedScene> prepare_scene(const std::filesystem::path&, const std::vector<std::string>& overrides,
                                    int threads);

}  // namespace marrow
