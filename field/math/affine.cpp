#include "field/math/affine.h"

#include "field/math/elementary.h"

namespace marrow {

Affine Affine::translate(const Vec3d& t) {
  Affine a;
  a.translation = t;
  return a;
}

Affine Affine::scale(const Vec3d& s) {
  Affine a;
  a.columns = {Vec3d{s.x, 0, 0}, Vec3d{0, s.y, 0}, Vec3d{0, 0, s.z}};
  return a;
}

// Rodrigues' formula, column by column: R v = v cos + (k x v) sin + k (k.v)(1 - cos).
Affine Affine::rotate(const UnitVec3& axis, double angle_rad) {
  const auto [s, c] = sincos(angle_rad);
  const Vec3d& k = axis;
  Affine a;
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3d e{};
    e[i] = 1;
    a.columns[i] = e * c + cross(k, e) * s + k * (k[i] * (1 - c));
  }
  return a;
}

Affine Affine::inverse() const {
  const double d = 1 / determinant();
  const Vec3d r0 = cross(columns[1], columns[2]) * d;  // rows of the inverse
  const Vec3d r1 = cross(columns[2], columns[0]) * d;
  const Vec3d r2 = cross(columns[0], columns[1]) * d;
  Affine a;
  a.columns = {Vec3d{r0.x, r1.x, r2.x}, Vec3d{r0.y, r1.y, r2.y}, Vec3d{r0.z, r1.z, r2.z}};
  a.translation = -a.vector(translation);
  return a;
}

Box3 Affine::box_around(const Box3& box) const {
  Box3 around;
  for (const Vec3d& p : corners_of(box)) around.include(point(p));
  return around;
}

std::optional<double> Affine::similarity() const {
  const double s2 = length_squared(columns[0]);
  const double tolerance = 1e-12 * s2;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::fabs(length_squared(columns[i]) - s2) > 4 * tolerance) return {};
    if (std::fabs(dot(columns[i], columns[(i + 1) % 3])) > 4 * tolerance) return {};
  }
  if (!(s2 > 0)) return {};
  return std::sqrt(s2);
}

Affine operator*(const Affine& c_from_b, const Affine& b_from_a) {
  Affine a;
  for (std::size_t i = 0; i < 3; ++i) a.columns[i] = c_from_b.vector(b_from_a.columns[i]);
  a.translation = c_from_b.point(b_from_a.translation);
  return a;
}

}  // namespace marrow
