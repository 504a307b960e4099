// How a surface scatters light at one point.
#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "field/math/vec3.h"
#include "materials/coated.h"
#include "materials/conductor.h"
#include "materials/diffuse.h"
#include "materials/scatter.h"

namespace marrow {

/// One of a closed set of reflecting lobes. Directions are in the local frame: z is the normal, and both wo and wi
/// point away from the surface. Nothing scatters below the surface: everything is 0 unless wo.z > 0 and wi.z > 0.
/// All lobes are reciprocal, none gives back more than it gets, and none is a delta: roughness 0 is a very narrow GGX.
class Bsdf {
 public:
  Bsdf(Diffuse lobe) : lobe_(std::move(lobe)) {}
  Bsdf(Conductor lobe) : lobe_(std::move(lobe)) {}
  Bsdf(Coated lobe) : lobe_(std::move(lobe)) {}

  /// f |cos wi| and the density of sample(), both at once.
  Scattered evaluate(const UnitVec3& wo, const UnitVec3& wi) const;
  Rgb eval(const UnitVec3& wo, const UnitVec3& wi) const { return evaluate(wo, wi).f_cos; }
  double pdf(const UnitVec3& wo, const UnitVec3& wi) const { return evaluate(wo, wi).pdf; }
  /// Nothing: absorbed.
  std::optional<BsdfSample> sample(const UnitVec3& wo, const Sample3& u) const;
  /// Share of diffuse light that is reflected.
  Rgb albedo() const;

 private:
  std::variant<Diffuse, Conductor, Coated> lobe_;
};

}  // namespace marrow
