// Places of a triangle by the shares of its corners, and what is linear over it.
#pragma once

#include <array>
#include <cstddef>

#include "field/description/field_node.h"
#include "field/math/vec3.h"

namespace marrow {

/// The shares of corners 1 and 2 in a place x of the plane are dot(x - vertex 0, dual).
struct Corners {
  Vec3d normal;  ///< twice the area long
  double area2;  ///< its square
  std::array<Vec3d, 2> dual;

  explicit Corners(const TriangleSkeleton& s) {
    const Vec3d a = s.vertices[1] - s.vertices[0], b = s.vertices[2] - s.vertices[0];
    normal = cross(a, b);
    area2 = length_squared(normal);
    dual = {cross(b, normal) / area2, cross(normal, a) / area2};
  }

  /// Of what is linear over the triangle, by what it is at the corners; in the plane.
  Vec3d gradient_of(const std::array<double, 3>& at) const {
    return dual[0] * (at[1] - at[0]) + dual[1] * (at[2] - at[0]);
  }
};

/// The shares of corners 1 and 2 at the share s of the way from corner i to corner j.
template <class Share>
std::array<Share, 2> on_edge(std::size_t i, std::size_t j, const Share& rest, const Share& s) {
  const auto of = [&](std::size_t corner) { return corner == j ? s : corner == i ? rest : Share{}; };
  return {of(1), of(2)};
}

}  // namespace marrow
