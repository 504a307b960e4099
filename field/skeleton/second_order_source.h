// What one source q of constant radius gives, with all second derivatives by p; internal to skeleton/.
#pragma once

#include <cstddef>

#include "field/kernel/profile.h"
#include "field/skeleton/second_order.h"

namespace marrow {

/// weight k(y) and weight 2 k'(y) v / tau, y = |v|^2 / tau^2, v = p - q.
inline SecondOrderSample second_order_source(const Profile& profile, const Vec3d& v, double tau, double weight) {
  const double y = length_squared(v) / (tau * tau);
  const auto [value, slope, curvature] = profile.at(y);
  // by |v|^2: of the field a', a''; of grad_S f = b v: b, b', b''
  const double a1 = weight * slope / (tau * tau), a2 = weight * curvature / (tau * tau * tau * tau);
  const double b = 2 * tau * a1, b1 = 2 * tau * a2, b2 = 2 * weight * profile.third(y) / (tau * tau * tau * tau * tau);
  SecondOrderSample s;
  s.field.value = weight * value;
  for (std::size_t i = 0; i < 3; ++i) {
    s.field.slope[i] = 2 * a1 * v[i];
    s.si[i].value = b * v[i];
    for (std::size_t j = 0; j < 3; ++j) s.si[i].slope[j] = 2 * b1 * v[i] * v[j] + (i == j ? b : 0);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = HessianJet::at[k];
    s.field.curvature[k] = 4 * a2 * v[i] * v[j] + (i == j ? 2 * a1 : 0);
    for (std::size_t c = 0; c < 3; ++c) {
      double mixed = 4 * b2 * v[c] * v[i] * v[j];
      if (i == j) mixed += 2 * b1 * v[c];
      if (c == i) mixed += 2 * b1 * v[j];
      if (c == j) mixed += 2 * b1 * v[i];
      s.si[c].curvature[k] = mixed;
    }
  }
  return s;
}

}  // namespace marrow
