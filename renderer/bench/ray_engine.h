// What a program that finds surfaces along rays must answer to be measured.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "field/math/ray.h"
#include "renderer/bench/workload.h"
#include "renderer/geometry/surfaces.h"

namespace marrow {

/// How much was asked of an engine, and what it answered. Frames of several threads are added up.
struct RayCounts {
  std::uint64_t rays = 0;         ///< for the nearest hit
  std::uint64_t hits = 0;         ///< of these rays
  std::uint64_t shadow_rays = 0;  ///< for any hit
  std::uint64_t evaluations = 0;  ///< of the field, for the nearest hits; only of recording_engine_of()
  std::uint64_t uncertified = 0;  ///< rays for which it is not proved that nothing was skipped; likewise
  double light = 0;               ///< sum of all shades: nothing may be optimised away

  RayCounts& operator+=(const RayCounts&);
};

/// Of which place, normal and what leaving() needs are known.
using EngineHit = SurfaceHit;

/// Safe to use from many threads.
class RayEngine {
 public:
  virtual ~RayEngine() = default;
  virtual bool first_hit(const Ray&, EngineHit&, RayCounts&) const = 0;
  virtual bool occluded(const Ray&) const = 0;
  /// Many rays through one region: a hit for each, or nothing.
  virtual void first_hits(std::span<const Ray> rays, std::span<std::optional<EngineHit>> hits,
                          RayCounts& counts) const {
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!first_hit(rays[i], hits[i].emplace(), counts)) hits[i].reset();
  }
  /// As Surfaces::occluded().
  virtual void occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const {
    for (std::size_t i = 0; i < rays.size(); ++i) hidden[i] = occluded(rays[i]) ? 1 : 0;
  }
  /// As Surfaces::refine().
  virtual void refine() const {}
};

/// The surfaces of this project, which take many rays together; they must outlive the engine.
std::unique_ptr<RayEngine> engine_of(const Surfaces&);
/// The same ray by ray, and slower: it counts evaluations and what is not certified.
std::unique_ptr<RayEngine> recording_engine_of(const Surfaces&);

struct TriangleMesh {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Embree's own primitives under its own hierarchy, single rays, best build quality: round linear curves (cones with
/// spherical ends) and spheres, without any blend. Rays leave at a distance of a twentieth of the thinnest radius,
/// those of triangles at `offset`. Null when Embree cannot build them.
std::unique_ptr<RayEngine> embree_round_cones(const Workload&, int threads);
std::unique_ptr<RayEngine> embree_triangles(const TriangleMesh&, double offset, int threads);

}  // namespace marrow
