// How a surface scatters light at one point.
#include "materials/bsdf.h"

namespace marrow {

Scattered Bsdf::evaluate(const UnitVec3& wo, const UnitVec3& wi) const {
  if (!(wo.z() > 0) || !(wi.z() > 0)) return {};
  return std::visit([&](const auto& lobe) { return lobe.evaluate(wo, wi); }, lobe_);
}

std::optional<BsdfSample> Bsdf::sample(const UnitVec3& wo, const Sample3& u) const {
  if (!(wo.z() > 0)) return std::nullopt;
  return std::visit(
      [&](const auto& lobe) -> std::optional<BsdfSample> {
        const std::optional<UnitVec3> wi = lobe.sample(wo, u);
        if (!wi) return std::nullopt;
        const Scattered s = lobe.evaluate(wo, *wi);
        if (!(s.pdf > 0)) return std::nullopt;
        return BsdfSample{.wi = *wi, .weight = s.f_cos / s.pdf, .pdf = s.pdf};
      },
      lobe_);
}

Rgb Bsdf::albedo() const {
  return std::visit([](const auto& lobe) { return lobe.albedo(); }, lobe_);
}

}  // namespace marrow
