// The picture is made here: the only parallel loop over samples.
#include "renderer/transport/render.h"

#include <algorithm>
#include <cfenv>
#include <chrono>
#include <memory>
#include <mutex>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "renderer/transport/integrators/integrator.h"
#include "renderer/transport/pixel_block.h"
#include "renderer/transport/scout.h"
#include "renderer/transport/tile_order.h"

namespace marrow {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// The default floating-point environment, whatever the host program has set: flushing denormals to zero or another
// rounding would change the picture.
class DefaultFloatEnvironment {
 public:
  DefaultFloatEnvironment() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatEnvironment() { std::fesetenv(&before_); }
  DefaultFloatEnvironment(const DefaultFloatEnvironment&) = delete;
  DefaultFloatEnvironment& operator=(const DefaultFloatEnvironment&) = delete;

 private:
  std::fenv_t before_;
};

// Counts finished samples and tells the listener, not too often.
class Meter {
 public:
  Meter(const RenderOptions& options, std::uint64_t total) : listener_(options.progress) {
    progress_.total = total;
    if (options.time_limit_s) progress_.limit_s = *options.time_limit_s;
  }
  void add(std::uint64_t samples) {
    done_ += samples;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!listener_ || !lock.owns_lock() || elapsed() - progress_.elapsed_s < 0.1) return;
    tell();
  }
  void finish_pass(int samples_per_pixel) {
    const std::lock_guard lock(mutex_);
    progress_.samples_per_pixel = samples_per_pixel;
  }
  void finish() {
    if (listener_) tell();
  }
  double elapsed() const { return seconds_since(start_); }

 private:
  void tell() {
    progress_.done = done_;
    progress_.elapsed_s = elapsed();
    const double left = static_cast<double>(progress_.total - progress_.done);
    progress_.left_s = progress_.done == 0 ? 0 : progress_.elapsed_s * left / static_cast<double>(progress_.done);
    progress_.left_s = std::clamp(progress_.limit_s - progress_.elapsed_s, 0.0, progress_.left_s);
    listener_(progress_);
  }

  std::function<void(const Progress&)> listener_;
  Clock::time_point start_ = Clock::now();
  std::atomic<std::uint64_t> done_ = 0;
  std::mutex mutex_;
  Progress progress_;
};

// What stays the same during one call of render().
struct Job {
  const RenderScene& scene;
  const RenderSettings& settings;
  const RenderOptions& options;
  std::unique_ptr<const Integrator> integrator = make_integrator(settings);
  int samples = sample_count(settings);
  PixelJob pixels{scene, *integrator, settings.seed, samples};
  int side_of_block = scene.surfaces->traces_packets() ? block_side : side_of_block_of_lone_rays;

  bool interrupted() const { return options.interrupted && options.interrupted->load(std::memory_order_relaxed); }
};

void render_tile(const Job& job, const PixelWindow& tile, Pass pass, Film& film, Meter& meter) {
  const auto [width, height] = block_size(pass.count, job.side_of_block);
  for (int y = tile.y0; y < tile.y1; y += height)
    for (int x = tile.x0; x < tile.x1; x += width) {
      if (job.interrupted()) return;
      const PixelWindow block{x, y, std::min(x + width, tile.x1), std::min(y + height, tile.y1)};
      render_block(job.pixels, block, pass, film);
      meter.add(static_cast<std::uint64_t>(block.width()) * static_cast<std::uint64_t>(block.height()) *
                static_cast<std::uint64_t>(pass.count));
    }
}

template <class Visit>
void for_each_tile(const Job& job, const std::vector<PixelWindow>& tiles, const Visit& visit) {
  // Worker threads take over the floating-point settings of this one
  tbb::task_group_context context(tbb::task_group_context::isolated);
  context.capture_fp_settings();
  const auto visit_tiles = [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t t = range.begin(); t < range.end() && !job.interrupted(); ++t) visit(tiles[t]);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles.size(), 1), visit_tiles, tbb::simple_partitioner{},
                    context);
}

void render_pass(const Job& job, const std::vector<PixelWindow>& tiles, Pass pass, Film& film, Meter& meter) {
  for_each_tile(job, tiles, [&](const PixelWindow& tile) { render_tile(job, tile, pass, film, meter); });
}

// Before the first pass: all its rays then meet space that is divided, through surfaces that are refined.
void scout(const Job& job, const PixelWindow& window) {
  for (const auto [step, side] : scout_rounds) {
    const int together = std::min(side, step * job.side_of_block);
    for_each_tile(job, tiles_of(window, together),
                  [&](const PixelWindow& tile) { send_scouts(job.pixels, tile, step); });
    job.scene.surfaces->refine();
  }
}

// 1, 15, 16, 16, ... samples: a first picture soon, then never long without a look at the clock. Those of a pass go
// together, which makes each cheaper. Under a time limit no more than should fit at the speed so far; 0 when not even
// one does.
int next_count(const Job& job, int done, double elapsed_s) {
  constexpr int most = 16;
  int count = std::min(done == 0 ? 1 : most - done % most, job.samples - done);
  if (!job.options.time_limit_s || done == 0) return count;
  const double left_s = *job.options.time_limit_s - elapsed_s;
  while (count > 0 && elapsed_s / done * count > left_s) count /= 2;
  return count;
}

// Finer surfaces save some part of the time of a sample and cost less than one: after the first sample, which found
// most of what the camera sees, and twice more, for what longer paths have found.
bool worth_refining(int done, int samples) {
  return (done == 1 || done == 16 || done == 64) && samples - done >= std::max(2, done / 4);
}

void render_passes(const Job& job, Film& film, Meter& meter) {
  scout(job, film.data());
  const std::vector<PixelWindow> tiles = tiles_of(film.data(), std::max(job.options.tile_size, 1));
  for (int done = 0; done < job.samples;) {
    const int count = next_count(job, done, meter.elapsed());
    if (count == 0) {
      film.stopped_by = StopReason::Time;
      return;
    }
    render_pass(job, tiles, {done, count}, film, meter);
    if (job.interrupted()) {
      film.stopped_by = StopReason::Interrupted;
      return;
    }
    done += count;
    meter.finish_pass(done);
    if (worth_refining(done, job.samples)) job.scene.surfaces->refine();
  }
}

}  // namespace

int sample_count(const RenderSettings& settings) {
  return make_integrator(settings)->noise_free() ? 1 : std::max(settings.samples_per_pixel, 1);
}

Film empty_film(int width, int height, const std::optional<PixelWindow>& crop) {
  const PixelWindow display{0, 0, width, height};
  if (!crop) return {display, display};
  PixelWindow data{std::max(display.x0, crop->x0), std::max(display.y0, crop->y0), std::min(display.x1, crop->x1),
                   std::min(display.y1, crop->y1)};
  if (data.x0 >= data.x1 || data.y0 >= data.y1) data = {0, 0, 0, 0};
  return {display, data};
}

Film render(const RenderScene& scene, const RenderSettings& settings, const RenderOptions& options, Film film) {
  const DefaultFloatEnvironment defaults;
  const Job job{scene, settings, options};
  Meter meter(options, film.pixels().size() * static_cast<std::uint64_t>(job.samples));

  const int threads = options.threads > 0 ? options.threads : tbb::this_task_arena::max_concurrency();
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute([&] { render_passes(job, film, meter); });

  film.elapsed_s = meter.elapsed();
  meter.finish();
  return film;
}

Film render(const RenderScene& scene, const RenderSettings& settings, const RenderOptions& options) {
  return render(scene, settings, options, empty_film(scene.width, scene.height, options.crop));
}

}  // namespace marrow
