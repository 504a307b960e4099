// What is missing is told before the time is spent.
#include "renderer/app/picture/picture_advice.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace marrow {
namespace {

bool shines(const NamedMaterial& material) {
  const auto* diffuse = std::get_if<DiffuseDescription>(&material.what);
  return diffuse != nullptr && !(diffuse->emission == Rgb{0});
}

bool needs_light(const RenderSettings& render) {
  using Integrator = RenderSettings::Integrator;
  return render.integrator == Integrator::Path || render.integrator == Integrator::Direct;
}

}  // namespace

Diagnostics picture_advice(const SceneDescription& scene, const SceneInput& input) {
  Diagnostics advice;
  const auto warn = [&](const char* message, const char* hint) {
    Diagnostic warning;
    warning.where.file = input.path.string();
    warning.message = message;
    warning.hint = hint;
    warning.severity = Severity::Warning;
    advice.push_back(std::move(warning));
  };
  if (scene.objects.empty()) warn("the scene has no object", "list them under `objects:`");
  const bool is_dark = scene.lights.empty() && std::ranges::none_of(scene.materials, shines);
  if (is_dark && needs_light(scene.render))
    warn("nothing shines: the picture will be black", "add a light, such as lights: [constant: {}]");
  return advice;
}

}  // namespace marrow
