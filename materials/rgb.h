// Three linear channels: radiance, irradiance or reflectance in the working space.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace marrow {

struct Rgb {
  double r = 0, g = 0, b = 0;

  constexpr Rgb() = default;
  constexpr explicit Rgb(double grey) : r(grey), g(grey), b(grey) {}
  constexpr Rgb(double red, double green, double blue) : r(red), g(green), b(blue) {}
  constexpr double operator[](std::size_t i) const { return i == 0 ? r : i == 1 ? g : b; }
  constexpr double& operator[](std::size_t i) { return i == 0 ? r : i == 1 ? g : b; }
  friend constexpr Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
  friend constexpr Rgb operator-(Rgb a, Rgb b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
  friend constexpr Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
  friend constexpr Rgb operator/(Rgb a, Rgb b) { return {a.r / b.r, a.g / b.g, a.b / b.b}; }
  friend constexpr Rgb operator*(Rgb a, double s) { return {a.r * s, a.g * s, a.b * s}; }
  friend constexpr Rgb operator*(double s, Rgb a) { return a * s; }
  friend constexpr Rgb operator/(Rgb a, double s) { return {a.r / s, a.g / s, a.b / s}; }
  constexpr Rgb& operator+=(Rgb o) { return *this = *this + o; }
  constexpr Rgb& operator*=(Rgb o) { return *this = *this * o; }
  constexpr Rgb& operator*=(double s) { return *this = *this * s; }
  friend constexpr bool operator==(Rgb, Rgb) = default;
};

/// Luminance of linear Rec.709 primaries.
constexpr double luminance(Rgb c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }
constexpr double max_channel(Rgb c) { return c.r > c.g ? (c.r > c.b ? c.r : c.b) : (c.g > c.b ? c.g : c.b); }
constexpr bool is_black(Rgb c) { return c.r == 0 && c.g == 0 && c.b == 0; }
inline bool is_finite(Rgb c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

}  // namespace marrow
