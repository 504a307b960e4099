// What sources add up to at a place, and what polynomials say instead.
#pragma once

#include <cstddef>

#include "field/math/elementary.h"
#include "field/trace/sources/far_field.h"

namespace marrow::test {

/// The field and grad_S f.
struct FarValue {
  double f = 0;
  Vec3d g{};
};

/// In the cube's coordinates.
inline FarValue value_of(const FarField& far, const Vec3d& x) {
  FarValue v;
  for (std::size_t i = 0; i < monomial_count; ++i) {
    const Monomial& m = monomials[i];
    const double px = integer_power(x.x, m.a), py = integer_power(x.y, m.b), pz = integer_power(x.z, m.c);
    v.f += far.f[i] * px * py * pz;
    const double c = far.potential[i];
    if (m.a > 0) v.g.x += c * m.a * integer_power(x.x, m.a - 1) * py * pz;
    if (m.b > 0) v.g.y += c * m.b * px * integer_power(x.y, m.b - 1) * pz;
    if (m.c > 0) v.g.z += c * m.c * px * py * integer_power(x.z, m.c - 1);
  }
  return v;
}

}  // namespace marrow::test
