// A clear coat over a diffuse base.
#include "materials/coated.h"

#include "materials/cosine.h"
#include "materials/fresnel.h"

namespace marrow {

Coated::Coated(Rgb base, double roughness, double ior)
    : ggx_(Ggx::of_roughness(roughness)),
      ior_(ior),
      coat_(std::make_shared<DirectionalAlbedo>(ggx_, [ior](double c) { return fresnel_dielectric(c, ior); })) {
  const double inside = diffuse_fresnel_inside(ior);
  const double average = coat_->average();
  for (std::size_t i = 0; i < 3; ++i) {
    const double seen = base[i] * (1 - inside) / (1 - base[i] * inside);
    base_[i] = seen / (1 - average);
    albedo_[i] = average + seen * (1 - average);
    brightest_ = std::max(brightest_, seen);
  }
}

Scattered Coated::evaluate(const UnitVec3& wo, const UnitVec3& wi) const {
  const UnitVec3 h = normalize(wo.vec() + wi.vec());
  const double kept = (*coat_)(wo.z()), kept_i = (*coat_)(wi.z());
  const double cosine = cosine_pdf(wi), coat = choose_coat(kept);
  const double facets = fresnel_dielectric(std::min(dot(wo, h), 1.0), ior_) * ggx_.reflect(wo, wi, h);
  return {Rgb(facets) + base_ * ((1 - kept) * (1 - kept_i) * cosine), coat * ggx_.pdf(wo, h) + (1 - coat) * cosine};
}

std::optional<UnitVec3> Coated::sample(const UnitVec3& wo, const Sample3& u) const {
  if (u.z < choose_coat((*coat_)(wo.z()))) return ggx_.sample(wo, u.xy);
  return sample_cosine(u.xy);
}

}  // namespace marrow
