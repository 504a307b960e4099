// The loops that are timed: the same for every engine.
#pragma once

#include <vector>

#include "renderer/bench/ray_engine.h"
#include "renderer/bench/stop_request.h"

namespace marrow {

struct FrameSettings {
  int size = 1024;  ///< pixels of a side
  int threads = 2;
  StopRequest stop{};  ///< blocks of pixels or hits that have not begun are left out
};

/// One ray through the middle of each pixel, and one shadow ray from each hit that faces the sun; those of a block of
/// pixels are asked together.
RayCounts shaded_frame(const RayEngine&, const Workload&, const FrameSettings&);

/// The hits of the rays through the pixels' middles, block by block.
std::vector<EngineHit> hits_of_frame(const RayEngine&, const Workload&, const FrameSettings&);

/// From each of the hits four paths of at most `bounces` rays, each with the density of a diffuse surface; a path ends
/// when it leaves the scene. The directions are a function of hit, path and bounce.
RayCounts diffuse_paths(const RayEngine&, const std::vector<EngineHit>& from, int bounces, const FrameSettings&);

}  // namespace marrow
