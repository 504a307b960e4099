// Vectors of three numbers, and unit vectors as a type of their own.
#pragma once

#include <cmath>
#include <cstddef>

namespace marrow {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr T& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr const T& operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : z; }
  friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(T s, const Vec3& a) { return a * s; }
  friend constexpr Vec3 operator/(const Vec3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
  constexpr Vec3& operator*=(T s) { return *this = *this * s; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec3d = Vec3<double>;

template <class T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr T length_squared(const Vec3<T>& a) {
  return dot(a, a);
}
inline double length(const Vec3d& a) { return std::sqrt(dot(a, a)); }
constexpr Vec3d lerp(const Vec3d& a, const Vec3d& b, double t) { return a + (b - a) * t; }
inline bool is_finite(const Vec3d& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
constexpr double max_component(const Vec3d& a) { return a.x > a.y ? (a.x > a.z ? a.x : a.z) : (a.y > a.z ? a.y : a.z); }
inline Vec3d abs(const Vec3d& a) { return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}; }

/// A vector of length 1 up to rounding; made by normalize(), or by unchecked() where the maths says so.
class UnitVec3 {
 public:
  constexpr UnitVec3() = default;
  static constexpr UnitVec3 unchecked(const Vec3d& v) { return UnitVec3(v); }
  constexpr operator const Vec3d&() const { return v_; }
  constexpr const Vec3d& vec() const { return v_; }
  constexpr double x() const { return v_.x; }
  constexpr double y() const { return v_.y; }
  constexpr double z() const { return v_.z; }
  friend constexpr UnitVec3 operator-(const UnitVec3& a) { return UnitVec3(-a.v_); }
  friend constexpr bool operator==(const UnitVec3&, const UnitVec3&) = default;

 private:
  constexpr explicit UnitVec3(const Vec3d& v) : v_(v) {}
  Vec3d v_{0, 0, 1};
};

constexpr double dot(const UnitVec3& a, const UnitVec3& b) { return dot(a.vec(), b.vec()); }
constexpr double dot(const UnitVec3& a, const Vec3d& b) { return dot(a.vec(), b); }
constexpr double dot(const Vec3d& a, const UnitVec3& b) { return dot(a, b.vec()); }
constexpr Vec3d operator*(const UnitVec3& a, double s) { return a.vec() * s; }
constexpr Vec3d operator*(double s, const UnitVec3& a) { return a.vec() * s; }

/// v / |v|; the z axis when v has no direction.
inline UnitVec3 normalize(const Vec3d& v) {
  const double scale = max_component(abs(v));
  if (!(scale > 0) || !std::isfinite(scale)) return UnitVec3{};
  const Vec3d w = v / scale;  // so that squares neither overflow nor vanish
  return UnitVec3::unchecked(w / length(w));
}

/// A right-handed orthonormal frame with the given z axis.   [Duff et al. 2017, JCGT 6(1)]
struct Frame {
  UnitVec3 x, y, z;

  static Frame around(const UnitVec3& n) {
    const double sign = std::copysign(1.0, n.z());
    const double a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
    return {UnitVec3::unchecked({1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()}),
            UnitVec3::unchecked({b, sign + n.y() * n.y() * a, -n.y()}), n};
  }
  Vec3d to_local(const Vec3d& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
  Vec3d to_world(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
};

}  // namespace marrow
