// Lambert reflection.
#pragma once

#include "materials/cosine.h"
#include "materials/scatter.h"

namespace marrow {

/// f = albedo / pi.
class Diffuse {
 public:
  explicit Diffuse(Rgb albedo) : albedo_(albedo) {}
  Scattered evaluate(const UnitVec3& /*wo*/, const UnitVec3& wi) const {
    const double pdf = cosine_pdf(wi);
    return {albedo_ * pdf, pdf};
  }
  UnitVec3 sample(const UnitVec3& /*wo*/, const Sample3& u) const { return sample_cosine(u.xy); }
  Rgb albedo() const { return albedo_; }

 private:
  Rgb albedo_;
};

}  // namespace marrow
