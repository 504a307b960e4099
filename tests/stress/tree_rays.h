// Rays that are likely to find mistakes, for one scene of a general tree.
#pragma once

#include <array>

#include "field/math/ray.h"
#include "tests/stress/tree_scene.h"

namespace marrow::test {

enum class TreeFamily { Chord, Axis, Focus, Place, CellBoundary, Far, Tangent, Silhouette, Inside, Surface, Spawned };
inline constexpr std::array tree_family_names{
    "chord",   "axis-parallel", "near a hard place", "hard place",     "cell boundary", "far camera",
    "tangent", "silhouette",    "camera inside",     "on the surface", "spawned"};
inline constexpr std::size_t tree_family_count = tree_family_names.size();
/// Families before this begin a camera's distance away.
inline constexpr std::size_t tree_line_family_count = tree_family_count - 3;

/// A ray and the place that it is aimed at, as t: there it is looked at most closely.
struct AimedRay {
  Ray ray;
  double aim = 0;
};

/// A ray of the family. Tangent, Silhouette, Surface and Spawned ask the scene for surfaces first; where there are none
/// they give a chord.
AimedRay tree_ray(TreeFamily, Random&, const TreeScene&);

}  // namespace marrow::test
