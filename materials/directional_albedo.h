// How much light a GGX surface reflects in all, by the direction it is seen from.
#pragma once

#include <functional>
#include <vector>

#include "materials/ggx.h"

namespace marrow {

/// E(mu): the share of light arriving at cosine mu that a single bounce between facets returns, and its mean over
/// diffuse light. Tabulated for one width alpha and one Fresnel term by quadrature, and interpolated linearly in
/// sqrt(mu). Without Fresnel it is 1 - ln 2 at alpha = mu = 1.
class DirectionalAlbedo {
 public:
  /// `fresnel` maps the cosine between facet and ray to a reflectance.
  DirectionalAlbedo(const Ggx&, const std::function<double(double)>& fresnel);
  /// 0 <= mu <= 1.
  double operator()(double mu) const;
  /// 2 times the integral of E(mu) mu, exact for the interpolated table: compensation built on it loses nothing.
  double average() const { return average_; }

 private:
  std::vector<double> table_;
  double average_ = 0;
};

}  // namespace marrow
