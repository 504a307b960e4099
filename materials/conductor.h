// Rough metal.
#pragma once

#include <memory>
#include <optional>

#include "materials/directional_albedo.h"
#include "materials/ggx.h"
#include "materials/metals.h"
#include "materials/scatter.h"

namespace marrow {

/// A GGX surface of facets with complex Fresnel reflectance, and a diffuse-like lobe that returns what several bounces
/// between facets would: f_ms = F_ms (1 - E(o)) (1 - E(i)) / (pi (1 - E_avg)).   [Kulla & Conty 2017]
class Conductor {
 public:
  Conductor(const ComplexIndex&, double roughness);
  Scattered evaluate(const UnitVec3& wo, const UnitVec3& wi) const;
  std::optional<UnitVec3> sample(const UnitVec3& wo, const Sample3& u) const;
  Rgb albedo() const { return albedo_; }

 private:
  Ggx ggx_;
  ComplexIndex index_;
  std::shared_ptr<const DirectionalAlbedo> single_;  // of white facets
  Rgb multiple_;                                     // F_ms / (1 - E_avg)
  Rgb albedo_;
};

}  // namespace marrow
