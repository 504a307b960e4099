// How much light a flat boundary reflects.
#include "materials/fresnel.h"

#include <cmath>

namespace marrow {
namespace {

// One channel of a metal. a^2 + b^2 of Born & Wolf, with the two polarisations averaged.
double conductor_channel(double cos_theta, double n, double k) {
  const double c2 = cos_theta * cos_theta, s2 = 1 - c2;
  const double difference = n * n - k * k - s2;
  const double a2_plus_b2 = std::sqrt(difference * difference + 4 * n * n * k * k);
  const double a = std::sqrt(std::max(0.0, (a2_plus_b2 + difference) / 2));
  const double perpendicular = (a2_plus_b2 + c2 - 2 * cos_theta * a) / (a2_plus_b2 + c2 + 2 * cos_theta * a);
  const double x = c2 * a2_plus_b2 + s2 * s2, y = 2 * cos_theta * a * s2;
  const double parallel = perpendicular * (x - y) / (x + y);
  return (perpendicular + parallel) / 2;
}

// 2 times the integral of f(mu) mu over [0, 1] by Simpson's rule; f is smooth there. 256 steps: error below 1e-9.
template <class F>
double diffuse_mean(F f) {
  constexpr int steps = 256;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double mu = double(i) / steps;
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * f(mu) * mu;
  }
  return 2 * sum / (3 * steps);
}

}  // namespace

double fresnel_dielectric(double cos_theta, double eta) {
  const double sin2_inside = (1 - cos_theta * cos_theta) / (eta * eta);
  if (sin2_inside >= 1) return 1;
  const double cos_inside = std::sqrt(1 - sin2_inside);
  if (cos_theta == 0) return eta == 1 ? 0 : 1;
  const double parallel = (eta * cos_theta - cos_inside) / (eta * cos_theta + cos_inside);
  const double perpendicular = (cos_theta - eta * cos_inside) / (cos_theta + eta * cos_inside);
  return (parallel * parallel + perpendicular * perpendicular) / 2;
}

Rgb fresnel_conductor(double cos_theta, const ComplexIndex& index) {
  return {conductor_channel(cos_theta, index.n.r, index.k.r), conductor_channel(cos_theta, index.n.g, index.k.g),
          conductor_channel(cos_theta, index.n.b, index.k.b)};
}

double diffuse_fresnel_outside(double eta) {
  return diffuse_mean([eta](double mu) { return fresnel_dielectric(mu, eta); });
}

double diffuse_fresnel_inside(double eta) { return 1 - (1 - diffuse_fresnel_outside(eta)) / (eta * eta); }

Rgb diffuse_fresnel(const ComplexIndex& index) {
  const auto channel = [](double n, double k) {
    return diffuse_mean([n, k](double mu) { return conductor_channel(mu, n, k); });
  };
  return {channel(index.n.r, index.k.r), channel(index.n.g, index.k.g), channel(index.n.b, index.k.b)};
}

}  // namespace marrow
