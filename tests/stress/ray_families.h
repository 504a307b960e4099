// Rays that are likely to find mistakes, for one scene.
#pragma once

#include <array>
#include <vector>

#include "tests/stress/stress_scene.h"

namespace marrow::test {

enum class Family { Chord, Axis, Joint, Tangent, CellBoundary, Focus, Far, Silhouette, Spawned };
inline constexpr std::array family_names{"chord",         "axis-parallel", "joint",      "tangent", "cell boundary",
                                         "hardest place", "far camera",    "silhouette", "spawned"};
inline constexpr std::size_t family_count = family_names.size();

/// A ray of the family. Silhouette and Spawned ask the scene for surfaces first; where there are none they give a
/// chord.
Ray ray_of(Family, Random&, const StressScene&);

}  // namespace marrow::test
