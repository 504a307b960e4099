// A clear coat over a diffuse base.
#pragma once

#include <memory>
#include <optional>

#include "materials/directional_albedo.h"
#include "materials/ggx.h"
#include "materials/scatter.h"

namespace marrow {

/// A GGX dielectric boundary; all that it does not return reaches the base, which is seen through it:
/// f_base = rho' (1 - E(o)) (1 - E(i)) / (pi (1 - E_avg)). Light going back and forth below the boundary darkens and
/// saturates the base: rho' = rho (1 - k) / (1 - rho k), k the boundary's reflectance for diffuse light from inside.
/// A white base gives exactly 1.   [Kelemen & Szirmay-Kalos 2001; Saunderson 1942]
class Coated {
 public:
  Coated(Rgb base, double roughness, double ior);
  Scattered evaluate(const UnitVec3& wo, const UnitVec3& wi) const;
  std::optional<UnitVec3> sample(const UnitVec3& wo, const Sample3& u) const;
  Rgb albedo() const { return albedo_; }

 private:
  // Probability of choosing the coat: its share of what the surface returns.
  double choose_coat(double kept) const { return kept / (kept + brightest_ * (1 - kept)); }

  Ggx ggx_;
  double ior_;
  std::shared_ptr<const DirectionalAlbedo> coat_;
  Rgb base_;  // rho' / (1 - E_avg)
  Rgb albedo_;
  double brightest_ = 0;  // largest channel of rho'
};

}  // namespace marrow
