// Axis-aligned boxes.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "field/math/vec3.h"

namespace marrow {

/// Empty when any lower exceeds its upper; a default box is empty.
struct Box3 {
  static constexpr double inf = std::numeric_limits<double>::infinity();
  Vec3d lower{inf, inf, inf};
  Vec3d upper{-inf, -inf, -inf};

  bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
  Vec3d center() const { return (lower + upper) * 0.5; }
  Vec3d size() const { return upper - lower; }
  void include(const Vec3d& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], p[i]);
      upper[i] = std::max(upper[i], p[i]);
    }
  }
  void include(const Box3& b) {
    if (b.empty()) return;
    include(b.lower);
    include(b.upper);
  }
  Box3 padded(double margin) const {
    const Vec3d m{margin, margin, margin};
    return {lower - m, upper + m};
  }
  bool contains(const Vec3d& p) const {
    return p.x >= lower.x && p.x <= upper.x && p.y >= lower.y && p.y <= upper.y && p.z >= lower.z && p.z <= upper.z;
  }
};

/// What is in both.
inline Box3 common(Box3 a, const Box3& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    a.lower[i] = std::max(a.lower[i], b.lower[i]);
    a.upper[i] = std::min(a.upper[i], b.upper[i]);
  }
  return a;
}
inline bool do_overlap(const Box3& a, const Box3& b) { return !common(a, b).empty(); }

/// Precondition: the box is not empty.
inline std::array<Vec3d, 8> corners_of(const Box3& b) {
  std::array<Vec3d, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = {i & 1 ? b.lower.x : b.upper.x, i & 2 ? b.lower.y : b.upper.y, i & 4 ? b.lower.z : b.upper.z};
  return corners;
}

/// Largest |coordinate| of the box: the M of the padding rule for float boxes.
inline double largest_coordinate(const Box3& b) {
  return std::max(max_component(abs(b.lower)), max_component(abs(b.upper)));
}

}  // namespace marrow
