// The GGX distribution of microfacets with Smith's shadowing.
#include "materials/ggx.h"

#include <algorithm>
#include <numbers>

#include "field/math/elementary.h"

namespace marrow {

Ggx Ggx::of_roughness(double roughness) { return Ggx(std::max(roughness * roughness, smallest_alpha)); }

Ggx::Ggx(double alpha) : alpha_(alpha), alpha2_(alpha * alpha) {}

double Ggx::normals(const Vec3d& h) const {
  if (!(h.z > 0)) return 0;
  // 1 / (pi alpha^2 cos^4 (1 + tan^2/alpha^2)^2), written without tan
  const double stretched = (h.x * h.x + h.y * h.y) / alpha2_ + h.z * h.z;
  return 1 / (std::numbers::pi * alpha2_ * stretched * stretched);
}

double Ggx::reflect(const UnitVec3& wo, const UnitVec3& wi, const UnitVec3& h) const {
  // G2 = 2 cos_o cos_i / (cos_o slant(cos_i) + cos_i slant(cos_o))   [Heitz 2014, eq. 99]
  return normals(h) * wi.z() / (2 * (wo.z() * slant(wi.z()) + wi.z() * slant(wo.z())));
}

double Ggx::pdf(const UnitVec3& wo, const UnitVec3& h) const { return normals(h) / (2 * (wo.z() + slant(wo.z()))); }

UnitVec3 Ggx::sample_normal(const UnitVec3& wo, Sample2 u) const {
  // Stretch to a hemisphere, where the visible facets are a spherical cap around wo, mirrored   [Dupuy & Benyoub 2023]
  const UnitVec3 stretched = normalize({alpha_ * wo.x(), alpha_ * wo.y(), wo.z()});
  const double z = (1 - u.y) * (1 + stretched.z()) - stretched.z();
  const double radius = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
  const SinCos phi = sincos(2 * std::numbers::pi * u.x);
  const Vec3d h = Vec3d{radius * phi.cos, radius * phi.sin, z} + stretched.vec();
  return normalize({alpha_ * h.x, alpha_ * h.y, std::max(h.z, 0.0)});
}

std::optional<UnitVec3> Ggx::sample(const UnitVec3& wo, Sample2 u) const {
  const UnitVec3 h = sample_normal(wo, u);
  const UnitVec3 wi = normalize(h * (2 * dot(wo, h)) - wo.vec());
  if (!(wi.z() > 0)) return std::nullopt;
  return wi;
}

}  // namespace marrow
