// Rough metal.
#include "materials/conductor.h"

#include "materials/cosine.h"
#include "materials/fresnel.h"

namespace marrow {
namespace {

// Below this share of lost light compensation is left out: it is invisible, and its quotient is rounding noise.
constexpr double negligible_loss = 1e-7;

// F_ms = F^2 E / (1 - F (1 - E)), the geometric series over further bounces, divided by 1 - E.   [Kulla & Conty 2017]
double multiple_bounces(double fresnel, double average) {
  if (1 - average < negligible_loss) return 0;
  return fresnel * fresnel * average / ((1 - fresnel * (1 - average)) * (1 - average));
}

}  // namespace

Conductor::Conductor(const ComplexIndex& index, double roughness)
    : ggx_(Ggx::of_roughness(roughness)),
      index_(index),
      single_(std::make_shared<DirectionalAlbedo>(ggx_, [](double) { return 1.0; })) {
  const Rgb fresnel = diffuse_fresnel(index);
  const double average = single_->average();
  for (std::size_t i = 0; i < 3; ++i) {
    multiple_[i] = multiple_bounces(fresnel[i], average);
    albedo_[i] = fresnel[i] * average + multiple_[i] * (1 - average) * (1 - average);
  }
}

Scattered Conductor::evaluate(const UnitVec3& wo, const UnitVec3& wi) const {
  const UnitVec3 h = normalize(wo.vec() + wi.vec());
  const double kept = (*single_)(wo.z()), lost = 1 - kept;
  const double lost_i = 1 - (*single_)(wi.z());
  const double cosine = cosine_pdf(wi);
  const Rgb facets = fresnel_conductor(std::min(dot(wo, h), 1.0), index_) * ggx_.reflect(wo, wi, h);
  return {facets + multiple_ * (lost * lost_i * cosine), kept * ggx_.pdf(wo, h) + lost * cosine};
}

std::optional<UnitVec3> Conductor::sample(const UnitVec3& wo, const Sample3& u) const {
  if (u.z < (*single_)(wo.z())) return ggx_.sample(wo, u.xy);
  return sample_cosine(u.xy);
}

}  // namespace marrow
