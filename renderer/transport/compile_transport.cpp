// From a scene's description to what the integrators see.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "field/base/overloaded.h"
#include "renderer/transport/render_scene.h"

namespace marrow {
namespace {

void append(Diagnostics& problems, const Diagnostics& more, const SourceLocation& where) {
  for (Diagnostic d : more) {
    if (d.where.line == 0 && d.where.file.empty()) d.where = where;
    problems.push_back(std::move(d));
  }
}

std::vector<Material> compile_materials(const std::vector<NamedMaterial>& named, Diagnostics& problems) {
  std::vector<Material> materials;
  for (const NamedMaterial& m : named) {
    auto made = compile(m.what);
    if (made) materials.push_back(std::move(*made));
    else append(problems, made.why(), m.where);
  }
  return materials;
}

Result<Light> compile_image(const ImageLight& light, bool z_up, const LoadEnvironment& load) {
  auto image = load(light.file);
  if (!image) return image.why();
  const auto values = image->rgb.size(), pixels = static_cast<std::size_t>(std::max(image->width, 0)) *
                                                  static_cast<std::size_t>(std::max(image->height, 0));
  if (pixels == 0 || values != 3 * pixels) return failure("an environment image without pixels");
  return Light(Environment(std::move(*image), light.scale, light.rotate_deg, z_up));
}

Result<Light> compile_sun(const SunLight& sun) {
  if (!(length(sun.direction) > 0)) return failure("a sun without a direction");
  return Light(Sun(sun));
}

Result<Light> compile_rectangle(const RectangleLight& light, bool z_up) {
  if (!(length(light.normal) > 0)) return failure("a rectangle light without a normal");
  if (!(light.width > 0 && light.height > 0)) return failure("a rectangle light without an area");
  return Light(Rectangle(light, z_up));
}

Result<Light> compile_light(const LightDescription& light, bool z_up, const LoadEnvironment& load) {
  return std::visit(Overloaded{[](const ConstantLight& l) -> Result<Light> { return Light(ConstantSky{l.radiance}); },
                               [&](const ImageLight& l) { return compile_image(l, z_up, load); },
                               [](const SunLight& l) { return compile_sun(l); },
                               [&](const RectangleLight& l) { return compile_rectangle(l, z_up); },
                               [](const PointLight& l) -> Result<Light> {
                                 return Light(PointSource{l.position, l.intensity});
                               }},
                    light.what);
}

LightSet compile_lights(const SceneDescription& scene, const Surfaces& surfaces, const LoadEnvironment& load,
                        Diagnostics& problems) {
  std::vector<Light> lights;
  for (const LightDescription& light : scene.lights) {
    auto made = compile_light(light, scene.z_up, load);
    if (made) lights.push_back(std::move(*made));
    else append(problems, made.why(), light.where);
  }
  const Box3 bounds = surfaces.bounds();
  return LightSet(std::move(lights), bounds.empty() ? scene.camera.to : bounds.center());
}

Camera compile_camera(const SceneDescription& scene, Diagnostics& problems) {
  const CameraDescription& c = scene.camera;
  const auto require = [&](bool holds, const char* message) {
    if (!holds) problems.push_back(failure(message));
    return holds;
  };
  const Vec3d view = c.to - c.from;
  bool ok = require(scene.film.width > 0 && scene.film.height > 0, "a film without pixels");
  ok &= require(length(view) > 0, "the camera looks at the place where it stands");
  ok &= require(length(cross(normalize(view).vec(), normalize(c.up).vec())) > 1e-9,
                "the camera looks along its up vector");
  const bool perspective = c.type == CameraDescription::Type::Perspective;
  ok &= require(!perspective || (c.fov_deg > 0 && c.fov_deg < 180),
                "the camera's field of view is not in (0, 180) degrees");
  ok &= require(perspective || c.height > 0, "the camera's picture has no height");
  return ok ? Camera(c, scene.film.width, scene.film.height) : Camera();
}

}  // namespace

Result<RenderScene> compile_transport(const SceneDescription& scene, const Surfaces& surfaces,
                                      const LoadEnvironment& load) {
  Diagnostics problems;
  RenderScene compiled{.surfaces = &surfaces,
                       .materials = compile_materials(scene.materials, problems),
                       .lights = compile_lights(scene, surfaces, load, problems),
                       .camera = compile_camera(scene, problems),
                       .width = scene.film.width,
                       .height = scene.film.height};
  compiled.has_emission = std::ranges::any_of(compiled.materials, &Material::emits);
  for (const ObjectDescription& object : scene.objects)
    if (object.material.index() >= scene.materials.size())
      problems.push_back({.where = object.where, .message = '"' + object.name + "\" has no material", .hint = {}});
  if (!problems.empty()) return problems;
  return compiled;
}

}  // namespace marrow
