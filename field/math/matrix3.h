// General 3 x 3 matrices: Jacobians of vector fields.
#pragma once

#include <array>

#include "field/math/vec3.h"

namespace marrow {

/// Row i, column j is rows[i][j]; of a Jacobian, the derivative of component i along axis j.
struct Matrix3 {
  std::array<Vec3d, 3> rows{};

  static constexpr Matrix3 scaled_identity(double s) { return {{Vec3d{s, 0, 0}, Vec3d{0, s, 0}, Vec3d{0, 0, s}}}; }
  /// a b^T.
  static constexpr Matrix3 outer(const Vec3d& a, const Vec3d& b) { return {{b * a.x, b * a.y, b * a.z}}; }

  constexpr Vec3d times(const Vec3d& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  constexpr Vec3d transposed_times(const Vec3d& v) const { return rows[0] * v.x + rows[1] * v.y + rows[2] * v.z; }

  constexpr Matrix3& operator+=(const Matrix3& b) {
    for (std::size_t i = 0; i < 3; ++i) rows[i] += b.rows[i];
    return *this;
  }
  friend constexpr Matrix3 operator+(Matrix3 a, const Matrix3& b) { return a += b; }
  friend constexpr Matrix3 operator*(Matrix3 a, double s) {
    for (auto& row : a.rows) row *= s;
    return a;
  }
  friend constexpr bool operator==(const Matrix3&, const Matrix3&) = default;
};

}  // namespace marrow
