// The GGX distribution of microfacets with Smith's shadowing.
#pragma once

#include <optional>

#include "field/math/vec3.h"
#include "materials/sample.h"

namespace marrow {

/// Isotropic, reflecting. Local frame, z is the normal; wo.z > 0 and wi.z > 0 are preconditions.
/// [Walter et al. 2007; Heitz 2014, height-correlated Smith; Dupuy & Benyoub 2023, sampling]
class Ggx {
 public:
  /// Narrower than this is not told from a mirror: facets tilt by about 1e-4 rad. It keeps densities finite, so that
  /// a smooth surface needs no case of its own.
  static constexpr double smallest_alpha = 1e-4;

  /// alpha = roughness squared, at least smallest_alpha.
  static Ggx of_roughness(double roughness);
  explicit Ggx(double alpha);

  double alpha() const { return alpha_; }
  /// Density of facet normals h, per solid angle and area of the macrosurface.
  double normals(const Vec3d& h) const;
  /// Share of facets facing w that w sees.
  double shadowing(double cos_w) const { return 2 * cos_w / (cos_w + slant(cos_w)); }
  /// D G2 / (4 wo.z): the reflected light of a white facet, f |cos wi|.
  double reflect(const UnitVec3& wo, const UnitVec3& wi, const UnitVec3& h) const;
  /// Density of wi drawn by sample(): D G1(wo) / (4 wo.z).
  double pdf(const UnitVec3& wo, const UnitVec3& h) const;
  /// A facet normal among those that wo sees.
  UnitVec3 sample_normal(const UnitVec3& wo, Sample2 u) const;
  /// wo mirrored at a facet; nothing when it leaves below the surface.
  std::optional<UnitVec3> sample(const UnitVec3& wo, Sample2 u) const;

 private:
  double slant(double cos_w) const { return std::sqrt(alpha2_ + (1 - alpha2_) * cos_w * cos_w); }

  double alpha_, alpha2_;
};

}  // namespace marrow
