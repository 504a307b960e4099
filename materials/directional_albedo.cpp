// How much light a GGX surface reflects in all, by the direction it is seen from.
#include "materials/directional_albedo.h"

#include <algorithm>

namespace marrow {
namespace {

// Nodes at mu = s^2, s equally spaced: dense near grazing, where E bends most.
constexpr std::size_t nodes = 64;
constexpr int across = 48, around = 16;

// The mean of F G2/G1 over visible facets, of which one half of the plane of wo is enough. Facets of a narrow GGX that
// tilt enough to lose light are few and lie at u.y = 1: midpoints in s with u.y = 1 - s^3 crowd there.
double single_bounce(const Ggx& ggx, double mu, const std::function<double(double)>& fresnel) {
  const UnitVec3 wo = UnitVec3::unchecked({std::sqrt(std::max(0.0, 1 - mu * mu)), 0, mu});
  double sum = 0, weights = 0;
  for (int j = 0; j < across; ++j) {
    const double s = (j + 0.5) / across, weight = s * s;
    weights += weight * around;
    for (int i = 0; i < around; ++i) {
      const UnitVec3 h = ggx.sample_normal(wo, {(i + 0.5) / (2 * around), 1 - s * s * s});
      const double cos_oh = dot(wo, h);
      const UnitVec3 wi = normalize(h * (2 * cos_oh) - wo.vec());
      if (!(wi.z() > 0)) continue;
      sum += weight * fresnel(std::min(cos_oh, 1.0)) * ggx.reflect(wo, wi, h) / ggx.pdf(wo, h);
    }
  }
  return sum / weights;
}

// 2 times the integral of the interpolant times mu: with mu = s^2 the integrand is 4 E(s) s^3, E linear between nodes.
double diffuse_mean(const std::vector<double>& table) {
  double sum = 0;
  const double step = 1.0 / (nodes - 1);
  for (std::size_t i = 0; i + 1 < nodes; ++i) {
    const double s0 = double(i) * step, s1 = double(i + 1) * step;
    const double slope = (table[i + 1] - table[i]) / step, offset = table[i] - slope * s0;
    const double s0_4 = s0 * s0 * s0 * s0, s1_4 = s1 * s1 * s1 * s1;
    sum += offset * (s1_4 - s0_4) + slope * 0.8 * (s1_4 * s1 - s0_4 * s0);
  }
  return sum;
}

}  // namespace

DirectionalAlbedo::DirectionalAlbedo(const Ggx& ggx, const std::function<double(double)>& fresnel) : table_(nodes) {
  constexpr double grazing = 1e-4;  // in place of 0, where no facet is seen
  for (std::size_t i = 0; i < nodes; ++i) {
    const double s = double(i) / (nodes - 1);
    table_[i] = std::clamp(single_bounce(ggx, std::max(s * s, grazing), fresnel), 0.0, 1.0);
  }
  average_ = diffuse_mean(table_);
}

double DirectionalAlbedo::operator()(double mu) const {
  const double x = std::sqrt(std::clamp(mu, 0.0, 1.0)) * (nodes - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), nodes - 2);
  const double t = x - double(i);
  return table_[i] + (table_[i + 1] - table_[i]) * t;
}

}  // namespace marrow
