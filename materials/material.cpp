// From what an author wrote to a material ready for use.
#include "materials/material.h"

#include <string>

#include "field/base/overloaded.h"
#include "materials/fresnel.h"

namespace marrow {
namespace {

void require(Diagnostics& problems, bool holds, std::string message, std::string hint) {
  if (!holds) problems.push_back({.where = {}, .message = std::move(message), .hint = std::move(hint)});
}

void require_reflectance(Diagnostics& problems, Rgb color) {
  for (std::size_t i = 0; i < 3; ++i)
    if (!(color[i] >= 0 && color[i] <= 1))
      return require(problems, false, "a colour that reflects more than it gets, or less than nothing",
                     "each channel lies in [0, 1]");
}

void require_roughness(Diagnostics& problems, double roughness) {
  require(problems, roughness >= 0 && roughness <= 1, "roughness out of range", "it lies in [0, 1]");
}

std::string known_metals() {
  std::string list;
  for (const std::string_view name : metal_names()) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

Result<Material> diffuse(const DiffuseDescription& d) {
  Diagnostics problems;
  require_reflectance(problems, d.color);
  require(problems, is_finite(d.emission) && d.emission.r >= 0 && d.emission.g >= 0 && d.emission.b >= 0,
          "emission below zero", "each channel is 0 or more");
  if (!problems.empty()) return problems;
  return Material(Bsdf(Diffuse(d.color)), d.emission);
}

Result<Material> conductor(const ConductorDescription& d) {
  Diagnostics problems;
  const auto index = metal(d.metal);
  require(problems, index.has_value(), "unknown metal \"" + d.metal + '"', "known: " + known_metals());
  require_roughness(problems, d.roughness);
  if (!problems.empty()) return problems;
  return Material(Bsdf(Conductor(*index, d.roughness)));
}

Result<Material> coated(const CoatedDescription& d) {
  Diagnostics problems;
  require_reflectance(problems, d.color);
  require_roughness(problems, d.roughness);
  require(problems, d.ior > 1 && d.ior <= 4, "index of refraction out of range", "it lies in (1, 4]");
  if (!problems.empty()) return problems;
  return Material(Bsdf(Coated(d.color, d.roughness, d.ior)));
}

}  // namespace

Result<Material> compile(const MaterialDescription& description) {
  return std::visit(Overloaded{[](const DiffuseDescription& d) { return diffuse(d); },
                               [](const ConductorDescription& d) { return conductor(d); },
                               [](const CoatedDescription& d) { return coated(d); }},
                    description);
}

}  // namespace marrow
