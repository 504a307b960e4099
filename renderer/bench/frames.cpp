// The loops that are timed.
#include "renderer/bench/frames.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <numbers>
#include <span>

#include <tbb/blocked_range.h>
#include <tbb/blocked_range2d.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "field/math/elementary.h"
#include "field/math/ray_packet.h"

namespace marrow {
namespace {

class Camera {
 public:
  Camera(const Workload& w, int size) : eye_(w.eye), tan_(w.tan_half_fov), step_(2.0 / size) {}
  Ray ray(int x, int y) const {
    const Vec3d d{((x + 0.5) * step_ - 1) * tan_, (1 - (y + 0.5) * step_) * tan_, -1};
    return {eye_, UnitVec3::unchecked(d / length(d))};
  }

 private:
  Vec3d eye_;
  double tan_, step_;
};

// Work in the given number of threads, with results added up.
template <class Range, class Body>
RayCounts counted(const FrameSettings& settings, const Range& range, const Body& body) {
  RayCounts all;
  std::mutex mutex;
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(settings.threads));
  tbb::task_arena(settings.threads).execute([&] {
    tbb::parallel_for(range, [&](const Range& part) {
      RayCounts counts;
      body(part, counts);
      const std::lock_guard lock(mutex);
      all += counts;
    });
  });
  return all;
}

using Pixels = tbb::blocked_range2d<int>;

// As many as rays in a packet, which are asked together; engines without packets take them one by one.
constexpr int block_side = 4;

struct Block {
  int x0, y0, x1, y1;
};

// Of fixed size, so that no engine is charged for memory of the loop.
using BlockRays = std::array<Ray, RayPacket::size>;
using BlockHits = std::array<EngineHit, RayPacket::size>;

// Light of the hits whose bits are set.
double shade(const RayEngine& engine, const Vec3d& toward_light, const BlockHits& hits, unsigned hit,
             RayCounts& counts) {
  constexpr double ambient = 0.1, albedo = 0.8;
  std::array<double, RayPacket::size> facing;
  BlockRays shadow_rays;
  std::size_t lit = 0;
  for_each_lane(hit, [&](std::size_t lane) {
    const EngineHit& at = hits[lane];
    facing[lit] = dot(at.normal, toward_light);
    if (facing[lit] > 0) shadow_rays[lit++] = {at.outside, UnitVec3::unchecked(toward_light)};
  });
  counts.shadow_rays += lit;
  const unsigned hidden = engine.which_occluded(std::span(shadow_rays).first(lit));
  double light = ambient * std::popcount(hit);
  for (std::size_t i = 0; i < lit; ++i)
    if (!(hidden >> i & 1)) light += albedo * facing[i];
  return light;
}

void shade_block(const RayEngine& engine, const Camera& camera, const Vec3d& toward_light, const Block& block,
                 RayCounts& counts) {
  BlockRays rays;
  BlockHits hits;
  std::size_t count = 0;
  for (int y = block.y0; y < block.y1; ++y)
    for (int x = block.x0; x < block.x1; ++x) rays[count++] = camera.ray(x, y);
  const unsigned hit = engine.first_hits(std::span(rays).first(count), hits, counts);
  counts.rays += count;
  counts.hits += static_cast<std::uint64_t>(std::popcount(hit));
  counts.light += shade(engine, toward_light, hits, hit, counts);
}

// A bijection of 64 bits whose outputs look random: the finaliser of splitmix64.
double random_from(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

UnitVec3 diffuse_direction(const Vec3d& normal, std::uint64_t seed) {
  const double u = random_from(2 * seed), radius = std::sqrt(u);
  const SinCos phi = sincos(2 * std::numbers::pi * random_from(2 * seed + 1));
  const Frame frame = Frame::around(UnitVec3::unchecked(normal));
  return normalize(frame.to_world({radius * phi.cos, radius * phi.sin, std::sqrt(std::max(0.0, 1 - u))}));
}

}  // namespace

RayCounts shaded_frame(const RayEngine& engine, const Workload& workload, const FrameSettings& settings) {
  const Camera camera(workload, settings.size);
  return counted(settings, Pixels(0, settings.size, 16, 0, settings.size, 16), [&](const Pixels& part, RayCounts& c) {
    const int right = part.cols().end(), bottom = part.rows().end();
    for (int y = part.rows().begin(); y < bottom; y += block_side)
      for (int x = part.cols().begin(); x < right; x += block_side)
        shade_block(engine, camera, workload.toward_light,
                    {x, y, std::min(x + block_side, right), std::min(y + block_side, bottom)}, c);
  });
}

std::vector<EngineHit> hits_of_frame(const RayEngine& engine, const Workload& workload, const FrameSettings& settings) {
  const Camera camera(workload, settings.size);
  std::vector<EngineHit> hits;
  RayCounts unused;
  for (int y = 0; y < settings.size; ++y)
    for (int x = 0; x < settings.size; ++x)
      if (EngineHit hit; engine.first_hit(camera.ray(x, y), hit, unused)) hits.push_back(hit);
  return hits;
}

RayCounts diffuse_paths(const RayEngine& engine, const std::vector<EngineHit>& from, int bounces,
                        const FrameSettings& settings) {
  using Hits = tbb::blocked_range<std::size_t>;
  return counted(settings, Hits(0, from.size(), 256), [&](const Hits& part, RayCounts& c) {
    for (std::size_t i = part.begin(); i < part.end(); ++i) {
      EngineHit hit = from[i];
      for (int bounce = 0; bounce < bounces; ++bounce) {
        const auto seed = static_cast<std::uint64_t>(i) * 16 + static_cast<std::uint64_t>(bounce);
        ++c.rays;
        if (!engine.first_hit({hit.outside, diffuse_direction(hit.normal, seed)}, hit, c)) break;
        ++c.hits;
      }
    }
  });
}

}  // namespace marrow
