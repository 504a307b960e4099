// A face of a mesh, as triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/math/vec3.h"

namespace marrow {

/// Concave polygons of more corners are not split: looking for ears takes up to the cube of their number.
inline constexpr std::size_t most_concave_corners = 4096;

/// Adds n - 2 triangles of a polygon of n corners (indices into `positions`, in order around it; at least three), which
/// turn as it does. A polygon is seen along its mean normal (Newell), where it should be about flat and not cross
/// itself: a convex one becomes a fan, of another ears are cut off (Meisters 1975). False, and nothing is added: it is
/// concave and has more than `most_concave_corners`.
bool append_triangles(std::span<const std::uint32_t> corners, std::span<const Vec3d> positions,
                      std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace marrow
