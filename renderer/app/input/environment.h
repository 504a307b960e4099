// Pictures of all directions, from their files.
#pragma once

#include <filesystem>

#include "field/base/result.h"
#include "renderer/scene/scene_description.h"
#include "renderer/transport/lights/environment_image.h"

namespace marrow {

/// What read_rgb_image() reads, without values below 0. Its errors name the file and have no place of their own.
Result<EnvironmentImage> load_environment(const std::filesystem::path&);

/// What is wrong with the pictures of a scene's lights, at the places of the lights. Reads all of them.
Diagnostics check_environments(const SceneDescription&);

}  // namespace marrow
