// Rays that are likely to find mistakes, for one scene.
#pragma once

#include <array>
#include <vector>

#include "tests/stress/stress_scene.h"

namespace marrow::test {

enum class Family { Chord, Axis, Joint, Skeleton, Tangent, CellBoundary, Focus, Far, Silhouette, Surface, Spawned };
inline constexpr std::array family_names{"chord",      "axis-parallel",  "joint",         "in a skeleton",
                                         "tangent",    "cell boundary",  "hardest place", "far camera",
                                         "silhouette", "on the surface", "spawned"};
inline constexpr std::size_t family_count = family_names.size();
/// Families from here on start on a surface: a line has no such start.
inline constexpr std::size_t line_family_count = family_count - 2;

/// A ray of the family. Silhouette, Surface and Spawned ask the scene for surfaces first; where there are none they
/// give a chord.
Ray ray_of(Family, Random&, const StressScene&);

/// Rays to be asked side by side: of all families, some of them twice or with neighbours that differ by as little as
/// 1e-9 or are all but along an axis, some that begin in a body, at a hit or behind it, or end there.
std::vector<Ray> company_of(Random&, const StressScene&);

}  // namespace marrow::test
