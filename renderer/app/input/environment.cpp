// A picture that cannot be read is a mistake of the scene that names it.
#include "renderer/app/input/environment.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "renderer/output/image_file.h"

namespace marrow {

// Pictures that were resampled may dip below zero; light does not.
Result<EnvironmentImage> load_environment(const std::filesystem::path& path) {
  auto image = read_rgb_image(path);
  if (!image) {
    Diagnostics why = image.why();
    for (Diagnostic& d : why) {
      d.where = {};
      d.message = "`" + path.string() + "`: " + d.message;
    }
    return why;
  }
  for (float& sample : image->samples) sample = std::max(sample, 0.0F);
  return EnvironmentImage{image->width, image->height, std::move(image->samples)};
}

Diagnostics check_environments(const SceneDescription& scene) {
  Diagnostics problems;
  for (const LightDescription& light : scene.lights) {
    const auto* image = std::get_if<ImageLight>(&light.what);
    if (image == nullptr) continue;
    const auto loaded = load_environment(image->file);
    if (loaded) continue;
    for (Diagnostic d : loaded.why()) {
      d.where = light.where;
      problems.push_back(std::move(d));
    }
  }
  return problems;
}

}  // namespace marrow
