// A material ready for use: what surfaces ask for the way they scatter.
#pragma once

#include "field/base/result.h"
#include "field/math/vec3.h"
#include "materials/bsdf.h"
#include "materials/material_description.h"

namespace marrow {

class Material {
 public:
  explicit Material(Bsdf bsdf) : bsdf_(std::move(bsdf)), albedo_(bsdf_.albedo()) {}
  /// How the surface scatters at a point; textures will be looked up here, once per hit.
  const Bsdf& bsdf_at(const Vec3d& /*position*/) const { return bsdf_; }
  /// Share of diffuse light that is reflected.
  Rgb albedo_at(const Vec3d& /*position*/) const { return albedo_; }

 private:
  Bsdf bsdf_;
  Rgb albedo_;
};

/// Builds the tables a material needs (milliseconds). Fails for an unknown metal or a number out of its range; the
/// diagnostics have no place.
Result<Material> compile(const MaterialDescription&);

}  // namespace marrow
