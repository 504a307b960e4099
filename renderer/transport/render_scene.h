// What the integrators see: surfaces, materials, lights and a camera, ready for use.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "field/base/result.h"
#include "materials/material.h"
#include "renderer/geometry/surfaces.h"
#include "renderer/scene/scene_description.h"
#include "renderer/transport/camera/camera.h"
#include "renderer/transport/lights/environment_image.h"
#include "renderer/transport/lights/light_set.h"

namespace marrow {

/// Immutable while rendering. `surfaces` belongs to the caller and must outlive the scene.
struct RenderScene {
  const Surfaces* surfaces = nullptr;
  std::vector<Material> materials;  ///< MaterialId indexes this
  bool has_emission = false;        ///< whether any material emits
  LightSet lights;
  Camera camera;
  int width = 0, height = 0;  ///< of the whole film, pixels
};

/// Reads a latitude-longitude picture in the working space; the file named is the light's.
using LoadEnvironment = std::function<Result<EnvironmentImage>(const std::filesystem::path&)>;

/// Makes materials, lights and camera ready; gathers every problem. `load` is called once per image light.
Result<RenderScene> compile_transport(const SceneDescription&, const Surfaces&, const LoadEnvironment& load);

}  // namespace marrow
