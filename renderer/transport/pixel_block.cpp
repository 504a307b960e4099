#include "renderer/transport/pixel_block.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>
#include <vector>

namespace marrow {
namespace {

// Four by four, so that rays that follow each other are neighbours.
template <class Visit>
void for_each_pixel(const PixelWindow& window, const Visit& visit) {
  constexpr int side = 4;
  for (int y0 = window.y0; y0 < window.y1; y0 += side)
    for (int x0 = window.x0; x0 < window.x1; x0 += side)
      for (int y = y0; y < std::min(y0 + side, window.y1); ++y)
        for (int x = x0; x < std::min(x0 + side, window.x1); ++x) visit(x, y);
}

// Camera samples of the pixels of a block, those of a pixel in order: one entry a sample in all lists.
struct Block {
  Block(const PixelWindow& window, Pass samples, std::uint64_t seed, Film& film) {
    const std::size_t count = static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height()) *
                              static_cast<std::size_t>(samples.count);
    pixels.reserve(count);
    samplers.reserve(count);
    for_each_pixel(window, [&](int x, int y) {
      for (int i = samples.first; i < samples.first + samples.count; ++i) {
        pixels.push_back({x + 0.5, y + 0.5, &film.at(x, y)});
        samplers.emplace_back(x, y, seed).start(static_cast<std::uint32_t>(i));
      }
    });
    rays.resize(count);
    hits.resize(count);
    radiances.resize(count);
  }
  struct Pixel {
    double middle_x, middle_y;
    PixelSums* sums;
  };
  std::vector<Pixel> pixels;  // of each sample
  std::vector<Sampler> samplers;
  std::vector<Ray> rays;
  std::vector<std::optional<SurfaceHit>> hits;
  std::vector<Rgb> radiances;
};

void store(CentreHit& centre, const SurfaceHit& hit, const Camera& camera) {
  centre.depth = static_cast<float>(camera.depth(hit.position));
  for (std::size_t i = 0; i < 3; ++i) {
    centre.normal[i] = static_cast<float>(hit.normal.vec()[i]);
    centre.position[i] = static_cast<float>(hit.position[i]);
  }
  centre.object = hit.object.value + 1;
}

// Each tells what it took.
void trace_centres(const RenderScene& scene, Block& block) {
  for (std::size_t i = 0; i < block.pixels.size(); ++i)
    block.rays[i] = scene.camera.ray(block.pixels[i].middle_x, block.pixels[i].middle_y);
  std::vector<RayRecord> records(block.rays.size());
  scene.surfaces->first_hits(block.rays, block.hits, records);
  for (std::size_t i = 0; i < block.pixels.size(); ++i) {
    CentreHit& centre = block.pixels[i].sums->centre;
    centre.evaluations = records[i].evaluations;
    centre.certified = records[i].certified;
    if (block.hits[i]) store(centre, *block.hits[i], scene.camera);
  }
}

void trace_samples(const PixelJob& job, Block& block) {
  for (std::size_t i = 0; i < block.pixels.size(); ++i) {
    const Sample2 offset = job.filter.offset(block.samplers[i].next_2d());
    block.rays[i] = job.scene.camera.ray(block.pixels[i].middle_x + offset.x, block.pixels[i].middle_y + offset.y);
  }
  job.scene.surfaces->first_hits(block.rays, block.hits);
}

void add_samples(const PixelJob& job, Block& block) {
  const RenderScene& scene = job.scene;
  job.integrator.radiances({block.rays, block.hits, block.samplers}, scene, block.radiances);
  for (std::size_t i = 0; i < block.pixels.size(); ++i) {
    const auto& hit = block.hits[i];
    FilmSample sample{.radiance = block.radiances[i], .albedo = {}, .covered = true};
    if (hit) sample.albedo = scene.materials[hit->material.index()].albedo_at(hit->position);
    else sample.covered = scene.lights.finite_light_on(block.rays[i]);
    block.pixels[i].sums->add(sample);
  }
}

}  // namespace

void render_block(const PixelJob& job, const PixelWindow& window, Pass pass, Film& film) {
  if (pass.first == 0) {
    Block block(window, {0, 1}, job.seed, film);
    trace_centres(job.scene, block);
    if (job.samples == 1) return add_samples(job, block);
  }
  Block block(window, pass, job.seed, film);
  trace_samples(job, block);
  add_samples(job, block);
}

BlockSize block_size(int samples, int side) {
  const int halvings = std::bit_width(static_cast<unsigned>(samples)) - 1;
  return {std::max(1, side >> (halvings + 1) / 2), std::max(1, side >> halvings / 2)};
}

}  // namespace marrow
