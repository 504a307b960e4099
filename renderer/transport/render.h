// The picture is made here: the only parallel loop over samples.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "renderer/output/picture.h"
#include "renderer/scene/scene_description.h"
#include "renderer/transport/film/film.h"
#include "renderer/transport/render_scene.h"

namespace marrow {

/// How far a render is. A unit of work is one sample of one pixel.
struct Progress {
  std::uint64_t done = 0, total = 0;
  double elapsed_s = 0;
  double left_s = 0;  ///< estimate from the units done so far, at most up to the limit; 0 before the first
  double limit_s = std::numeric_limits<double>::infinity();  ///< no pass begins after so much time
  int samples_per_pixel = 0;                                 ///< every pixel has at least this many
};

struct RenderOptions {
  /// The part of the film to render, clipped to it; nothing: all of it. Pixels of a crop equal those of the whole
  /// film bit by bit.
  std::optional<PixelWindow> crop{};
  int threads = 0;     ///< 0: as many as the process may use (obeys affinity)
  int tile_size = 32;  ///< side in pixels of what one thread takes at a time; at least 1
  /// Checked between passes over the picture; the next pass is made small enough to fit. One sample is always taken.
  std::optional<double> time_limit_s{};
  /// Called by one thread at a time, at most ten times a second, and once at the end.
  std::function<void(const Progress&)> progress{};
  /// When it becomes true blocks of pixels at work are finished and the film is returned. Signal handlers may set it.
  const std::atomic<bool>* interrupted = nullptr;
};

/// How many samples render() takes of each pixel, when it is not stopped: the integrators `normals` and `depth` take
/// one.
int sample_count(const RenderSettings&);

/// Renders `settings.samples_per_pixel` samples in passes over the whole picture. The film has the same bits for any
/// number of threads. The integrators `normals` and `depth` take one sample through each pixel's middle.
Film render(const RenderScene&, const RenderSettings& settings, const RenderOptions& options = {});

/// The same onto a film that was made before, while the scene was: empty_film() of the same size and crop.
Film render(const RenderScene&, const RenderSettings& settings, const RenderOptions& options, Film empty);
Film empty_film(int width, int height, const std::optional<PixelWindow>& crop);

}  // namespace marrow
