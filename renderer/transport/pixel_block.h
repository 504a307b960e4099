// Neighbouring pixels whose rays go together.
#pragma once

#include <cstdint>

#include "renderer/transport/film/film.h"
#include "renderer/transport/integrators/integrator.h"
#include "renderer/transport/render_scene.h"
#include "renderer/transport/sampling/pixel_filter.h"

namespace marrow {

/// Samples `first` to `first + count - 1` of every pixel.
struct Pass {
  int first = 0, count = 0;
};

/// What a sample of a pixel is a function of.
struct PixelJob {
  const RenderScene& scene;
  const Integrator& integrator;
  std::uint64_t seed = 0;
  int samples = 1;  ///< of each pixel in all
  PixelFilter filter{};
};

/// The side of a block of one sample a pixel: many rays of it come to the same parts of surfaces, and what it holds
/// fits into a cache.
constexpr int block_side = 32;

/// The same where rays are traced one by one and may take long: a picture is interrupted between blocks.
constexpr int side_of_block_of_lone_rays = 4;

struct BlockSize {
  int width, height;  ///< in pixels
};
/// Of blocks with so many samples a pixel, at least one: they hold side x side samples, or up to twice as many, or the
/// samples of one pixel. The side is a power of two.
BlockSize block_size(int samples, int side);

/// The samples of a pass of a few pixels of the film, together. A pixel's samples are added in order,
/// and have the same bits whatever pixels are with it. The channels free of noise come from a ray through the pixel's
/// middle, traced in the first pass; where a pixel has a single sample that ray is the sample.
void render_block(const PixelJob&, const PixelWindow& block, Pass, Film&);

}  // namespace marrow
