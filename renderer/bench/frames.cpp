// The loops that are timed.
#include "renderer/bench/frames.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <optional>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/blocked_range2d.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "field/math/elementary.h"

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
    const auto work = [&](const Range& part) {
      if (settings.stop.is_made()) return;
      RayCounts counts;
      body(part, counts);
      const std::lock_guard lock(mutex);
      all += counts;
    };
    tbb::parallel_for(range, work, tbb::simple_partitioner{});
  });
  return all;
}

using Pixels = tbb::blocked_range2d<int>;

// Four by four, so that each sixteen are neighbours.
template <class Visit>
void for_each_pixel(const Pixels& pixels, const Visit& visit) {
  constexpr int side = 4;
  const int right = pixels.cols().end(), bottom = pixels.rows().end();
  for (int y0 = pixels.rows().begin(); y0 < bottom; y0 += side)
    for (int x0 = pixels.cols().begin(); x0 < right; x0 += side)
      for (int y = y0; y < std::min(y0 + side, bottom); ++y)
        for (int x = x0; x < std::min(x0 + side, right); ++x) visit(x, y);
}

// The side of a block of pixels whose rays are asked together; engines that cannot do so take them one by one.
constexpr int block_side = 32;
// As a picture traces several samples of a pixel together.
constexpr std::size_t paths_of_a_hit = 4;

// Kept from block to block, so that no engine is charged for memory of the loop.
struct BlockRays {
  std::vector<Ray> rays, shadow_rays;
  std::vector<std::optional<EngineHit>> hits;
  std::vector<double> facing;  // cosines at the lit hits
  std::vector<std::uint8_t> hidden;
};

// Light of the hits.
double shade(const RayEngine& engine, const Vec3d& toward_light, BlockRays& block, RayCounts& counts) {
  constexpr double ambient = 0.1, albedo = 0.8;
  block.shadow_rays.clear();
  block.facing.clear();
  double light = 0;
  for (const auto& hit : block.hits) {
    if (!hit) continue;
    ++counts.hits;
    light += ambient;
    const double facing = dot(hit->normal, toward_light);
    if (!(facing > 0)) continue;
    block.facing.push_back(facing);
    block.shadow_rays.push_back(hit->leaving(UnitVec3::unchecked(toward_light)));
  }
  block.hidden.resize(block.shadow_rays.size());
  counts.shadow_rays += block.shadow_rays.size();
  engine.occluded(block.shadow_rays, block.hidden);
  for (std::size_t i = 0; i < block.hidden.size(); ++i)
    if (block.hidden[i] == 0) light += albedo * block.facing[i];
  return light;
}

void shade_block(const RayEngine& engine, const Camera& camera, const Vec3d& toward_light, const Pixels& pixels,
                 RayCounts& counts) {
  thread_local BlockRays block;
  block.rays.clear();
  for_each_pixel(pixels, [&](int x, int y) { block.rays.push_back(camera.ray(x, y)); });
  block.hits.resize(block.rays.size());
  engine.first_hits(block.rays, block.hits, counts);
  counts.rays += block.rays.size();
  counts.light += shade(engine, toward_light, block, counts);
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
  return counted(
      settings, Pixels(0, settings.size, block_side, 0, settings.size, block_side),
      [&](const Pixels& part, RayCounts& c) { shade_block(engine, camera, workload.toward_light, part, c); });
}

std::vector<EngineHit> hits_of_frame(const RayEngine& engine, const Workload& workload, const FrameSettings& settings) {
  const Camera camera(workload, settings.size);
  std::vector<EngineHit> hits;
  RayCounts unused;
  for (int y = 0; y < settings.size && !settings.stop.is_made(); y += block_side)
    for (int x = 0; x < settings.size; x += block_side)
      for_each_pixel(Pixels(y, std::min(y + block_side, settings.size), x, std::min(x + block_side, settings.size)),
                     [&](int px, int py) {
                       if (EngineHit hit; engine.first_hit(camera.ray(px, py), hit, unused)) hits.push_back(hit);
                     });
  return hits;
}

namespace {

// A path that has come to a hit.
struct PathEnd {
  std::size_t path;
  EngineHit hit;
};

void go_on(const RayEngine& engine, std::vector<PathEnd>& ends, int bounce, RayCounts& counts) {
  std::vector<Ray> rays;
  for (const auto& [path, hit] : ends) {
    const auto seed = static_cast<std::uint64_t>(path) * 16 + static_cast<std::uint64_t>(bounce);
    rays.push_back(hit.leaving(diffuse_direction(hit.normal, seed)));
  }
  std::vector<std::optional<EngineHit>> hits(rays.size());
  engine.first_hits(rays, hits, counts);
  counts.rays += rays.size();
  std::vector<PathEnd> left;
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (hits[i]) left.push_back({ends[i].path, *hits[i]});
  counts.hits += left.size();
  ends = std::move(left);
}

}  // namespace

RayCounts diffuse_paths(const RayEngine& engine, const std::vector<EngineHit>& from, int bounces,
                        const FrameSettings& settings) {
  using Hits = tbb::blocked_range<std::size_t>;
  constexpr std::size_t together = block_side * block_side / paths_of_a_hit;
  return counted(settings, Hits(0, from.size(), together), [&](const Hits& part, RayCounts& c) {
    std::vector<PathEnd> ends;
    for (std::size_t i = part.begin(); i < part.end(); ++i)
      for (std::size_t k = 0; k < paths_of_a_hit; ++k) ends.push_back({i * paths_of_a_hit + k, from[i]});
    for (int bounce = 0; bounce < bounces && !ends.empty(); ++bounce) go_on(engine, ends, bounce, c);
  });
}

}  // namespace marrow
