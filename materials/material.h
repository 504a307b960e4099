// A material ready for use: what surfaces ask for the way they scatter.
#pragma once

#include "field/base/result.h"
#include "field/math/vec3.h"
#include "materials/bsdf.h"
#include "materials/material_description.h"

namespace marrow {

class Material {
 public:
  explicit Material(Bsdf bsdf, Rgb emission = {})
      : bsdf_(std::move(bsdf)), albedo_(bsdf_.albedo()), emission_(emission) {}
  /// How the surface scatters at a point; textures will be looked up here, once per hit.
  const Bsdf& bsdf_at(const Vec3d& /*position*/) const { return bsdf_; }
  /// Share of diffuse light that is reflected.
  Rgb albedo_at(const Vec3d& /*position*/) const { return albedo_; }
  /// Radiance that the surface sends out by itself, the same in all directions.
  Rgb emitted_at(const Vec3d& /*position*/) const { return emission_; }
  bool emits() const { return !is_black(emission_); }

 private:
  Bsdf bsdf_;
  Rgb albedo_;
  Rgb emission_;
};

/// Builds the tables a material needs (milliseconds). Fails for an unknown metal or a number out of its range; the
/// diagnostics have no place.
Result<Material> compile(const MaterialDescription&);

}  // namespace marrow
