// Many rays together: they wait at the parts that they come to, and those of part after part are traced side by side.
#pragma once

#include <span>
#include <vector>

#include "renderer/geometry/part_hierarchy.h"

namespace marrow {

/// What hierarchy.first_hit() finds for each of the rays, to the same bits. `visits`: of each ray, or none at all.
void stream_first_hits(const PartHierarchy&, std::span<const Ray>, std::span<PartHit> hits,
                       std::span<std::vector<RayVisit>> visits);
/// The same of hierarchy.any_hit().
void stream_any_hits(const PartHierarchy&, std::span<const Ray>, std::span<PartHit> hits);

}  // namespace marrow
