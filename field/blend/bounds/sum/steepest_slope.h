// The steepest slope of a kernel of finite height.
#pragma once

#include <cmath>

#include "field/kernel/profile.h"
#include "field/math/elementary.h"

namespace marrow {

/// sup |k'| over the scaled distance of a normalised Cauchy or compact kernel.
inline double steepest(const Profile& profile, const Kernel& kernel) {
  const int m = profile.degree();
  if (kernel.family == KernelFamily::Cauchy)  // m s x s (1 + s^2 x^2)^(-m/2-1), largest at s^2 x^2 = 1 / (m + 1)
    return m * kernel.shape / std::sqrt(m + 1.0) * pow(1 + 1.0 / (m + 1), -0.5 * m - 1) / profile.normalisation();
  // (m x / R^2) (1 - x^2/R^2)^(m/2-1), largest at x^2 = R^2 / (m - 1); the slope at the support for m = 2
  const double at_top = m > 2 ? pow(1 - 1.0 / (m - 1), 0.5 * m - 1) / std::sqrt(m - 1.0) : 1;
  return m / kernel.shape * at_top / profile.normalisation();
}

}  // namespace marrow
