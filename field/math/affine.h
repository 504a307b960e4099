// Affine maps: b_from_a maps coordinates of a to coordinates of b, so that b_from_a * a_from_c composes.
#pragma once

#include <array>
#include <optional>

#include "field/math/box3.h"
#include "field/math/vec3.h"

namespace marrow {

struct Affine {
  std::array<Vec3d, 3> columns{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  Vec3d translation{};

  static Affine translate(const Vec3d&);
  static Affine scale(const Vec3d&);
  /// Right-handed rotation about the axis through the origin, angle in radians.
  static Affine rotate(const UnitVec3& axis, double angle_rad);

  Vec3d point(const Vec3d& p) const { return vector(p) + translation; }
  Vec3d vector(const Vec3d& v) const { return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z; }
  /// Maps a covector (gradient, normal) of b to one of a: transposed linear part.
  Vec3d transposed(const Vec3d& g) const { return {dot(columns[0], g), dot(columns[1], g), dot(columns[2], g)}; }
  /// Around all that the points of the box are mapped to. Precondition: it is not empty.
  Box3 box_around(const Box3&) const;
  double determinant() const { return dot(columns[0], cross(columns[1], columns[2])); }
  /// Precondition: determinant() is not 0.
  Affine inverse() const;
  /// The scale s when the linear part is s times a rotation or reflection (relative 1e-12), else nothing.
  std::optional<double> similarity() const;

  friend Affine operator*(const Affine& c_from_b, const Affine& b_from_a);
  friend bool operator==(const Affine&, const Affine&) = default;
};

}  // namespace marrow
