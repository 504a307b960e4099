// Powers of one half, and normalisations in closed form.
#include "field/kernel/profile.h"

#include <cmath>
#include <numbers>

#include "field/kernel/inverse_family.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

double inverse_normalisation(int m, int dimension) {
  if (dimension == 0) return 1;
  return dimension == 1 ? curve_normalisation(m) : 2 * std::numbers::pi / (m - 2);
}

double cauchy_normalisation(double s, int m, int dimension) {
  const double u = 1 + s * s;
  if (dimension == 0) return 1 / half_power(u, m);
  if (dimension == 1) return curve_normalisation(m) / (half_power(u, m - 1) * s);
  return 2 * std::numbers::pi / ((m - 2) * s * s * half_power(u, m - 2));
}

// Of a curve R sqrt(pi) Gamma(m/2 + 1) / Gamma(m/2 + 3/2) v^((m+1)/2); the quotient is that of a curve of degree m + 3,
// here by its recurrence from m - 1. Of a surface 2 pi R^2 / (m + 2) v^((m+2)/2).
double compact_normalisation(double R, int m, int dimension) {
  const double v = 1 - 1 / (R * R);
  if (dimension == 0) return half_power(v, m);
  if (dimension == 2) return 2 * std::numbers::pi * R * R / (m + 2) * half_power(v, m + 2);
  const double quotient = curve_normalisation(m - 1) * (m - 2) / (m - 1) * m / (m + 1);
  return R * quotient * half_power(v, m + 1);
}

double normalisation_of(const Kernel& kernel, int m, int dimension) {
  if (kernel.family == KernelFamily::Inverse) return inverse_normalisation(m, dimension);
  return kernel.family == KernelFamily::Cauchy ? cauchy_normalisation(kernel.shape, m, dimension)
                                               : compact_normalisation(kernel.shape, m, dimension);
}

}  // namespace

Profile::Profile(const Kernel& kernel, int dimension)
    : kernel_(kernel),
      degree_(kernel.family == KernelFamily::Compact ? kernel.degree + 1 - dimension : kernel.degree - 1 + dimension),
      normalisation_(normalisation_of(kernel, degree_, dimension)) {}

ProfileSample Profile::at(double y) const {
  const double half = degree_ / 2.0, shape_squared = kernel_.shape * kernel_.shape;
  if (kernel_.family == KernelFamily::Inverse) {
    const double x = 1 / y, value = half_power(x, degree_);
    return {value, -half * x * value, half * (half + 1) * x * x * value};
  }
  if (kernel_.family == KernelFamily::Cauchy) {
    const double x = 1 / (1 + shape_squared * y), value = half_power(x, degree_), factor = shape_squared * x;
    return {value, -half * factor * value, half * (half + 1) * factor * factor * value};
  }
  const double x = 1 - y / shape_squared;
  if (!(x > 0)) return {0, 0, 0};
  const double base = half_power(x, degree_ - 4);
  return {base * x * x, -half / shape_squared * base * x, half * (half - 1) / (shape_squared * shape_squared) * base};
}

// Powers with the exponents h, h - 1 and h - 2 as factors; of the compact kernel one of them may be 0, and then all is.
double Profile::third(double y) const {
  const double half = degree_ / 2.0, shape_squared = kernel_.shape * kernel_.shape;
  if (kernel_.family == KernelFamily::Compact) {
    const double x = 1 - y / shape_squared, factor = half * (half - 1) * (half - 2);
    if (!(x > 0) || factor == 0) return 0;
    return -factor / (shape_squared * shape_squared * shape_squared) * pow(x, half - 3);
  }
  const bool is_inverse = kernel_.family == KernelFamily::Inverse;
  const double x = is_inverse ? 1 / y : 1 / (1 + shape_squared * y), factor = is_inverse ? x : shape_squared * x;
  return -half * (half + 1) * (half + 2) * factor * factor * factor * half_power(x, degree_);
}

}  // namespace marrow
