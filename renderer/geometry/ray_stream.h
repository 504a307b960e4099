// Many rays together: those that come to the same part are traced there side by side, whatever way they came.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/geometry/part_hierarchy.h"

namespace marrow {

/// What hierarchy.first_hit() finds for each of the rays, to the same bits. `visits`: of each ray, or none at all.
void stream_first_hits(const PartHierarchy&, std::span<const Ray>, std::span<PartHit> hits,
                       std::span<std::vector<RayVisit>> visits);
/// hidden[i] becomes 1 where hierarchy.occluded() says so of rays[i], else 0.
void stream_occluded(const PartHierarchy&, std::span<const Ray>, std::span<std::uint8_t> hidden);

}  // namespace marrow
