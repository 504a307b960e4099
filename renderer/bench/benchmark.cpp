// The workloads run, with Marrow and what there is of its peers in turns.
#include "renderer/bench/benchmark.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "renderer/bench/dual_mesh.h"
#include "renderer/bench/frames.h"
#include "renderer/bench/prepared_scene.h"
#include "renderer/bench/process_race.h"
#include "renderer/bench/temporary_folder.h"
#include "renderer/bench/workload.h"
#include "renderer/geometry/build_surfaces.h"
#include "renderer/transport/render.h"

namespace marrow {
namespace {

constexpr int bounces_of_a_path = 4;

// An engine at work: what is timed goes into the lists, one entry a round.
struct Racer {
  EngineFigures figures;
  std::unique_ptr<RayEngine> engine;
  std::vector<Cost> frames, bounces;
  std::vector<EngineHit> starts;
};

Cost per_ray(const Cost& cost, std::uint64_t rays) {
  const auto n = static_cast<double>(rays);
  return rays == 0 ? Cost{} : Cost{cost.wall_s / n, cost.cpu_s / n};
}

class Measurement {
 public:
  Measurement(const Workload& workload, const BenchSettings& settings, const std::filesystem::path& folder,
              const std::function<void(const std::string&)>& tell)
      : workload_(workload),
        settings_(settings),
        frame_{settings.size, settings.threads},
        scene_(folder / (workload.name + ".yaml")),
        tell_(tell) {
    out_.mesh_spacing = settings.mesh_spacing.value_or(max_component(workload.bounds().size()) / 500);
  }

  Result<WorkloadFigures> run() {
    out_.name = workload_.name;
    out_.about = workload_.about;
    out_.primitives = workload_.size();
    say("reading and building");
    if (auto status = write_scene(workload_, settings_.size, scene_); !status) return status.why();
    auto ready = prepare_scene(scene_, {}, settings_.threads);
    if (!ready) return ready.why();
    add_marrow(*ready);
    describe_surfaces(*ready);
    add_peers();
    race_frames(*ready);
    race_bounces(*ready);
    if (settings_.rules) compare_rules();
    if (settings_.processes) race_processes(workload_, settings_, scene_, tell_, out_);
    for (Racer& r : racers_) out_.engines.push_back(std::move(r.figures));
    return std::move(out_);
  }

 private:
  void say(const std::string& what) const { tell_(workload_.name + ": " + what); }

  void add_marrow(const PreparedScene& ready) {
    out_.read_s = ready.read_s;
    out_.build_s = ready.build_s;
    out_.first_ray_s = ready.first_ray_s;
    say("first frame");
    auto engine = engine_of(*ready.surfaces);
    out_.first_frame = cost_of([&] {
      shaded_frame(*engine, workload_, frame_);
      engine->refine();
    });
    EngineFigures figures;
    figures.name = "marrow";
    figures.primitives = workload_.size();
    figures.build_s = ready.build_s;
    add_racer(std::move(figures), std::move(engine));
  }

  // Null engines are told of, not raced.
  void add_racer(EngineFigures figures, std::unique_ptr<RayEngine> engine) {
    if (!engine) {
      out_.missing.push_back(figures.name + ": Embree could not build it");
      return;
    }
    Racer& racer = racers_.emplace_back();
    racer.figures = std::move(figures);
    racer.engine = std::move(engine);
  }

  // The mesh comes from surfaces of its own: its rays enter every cell, and what they build should not stay.
  TriangleMesh mesh_of_scene(double& seconds) const {
    TriangleMesh mesh;
    seconds = cost_of([&] {
                if (const auto scene = prepare_scene(scene_, {}, settings_.threads))
                  mesh = dual_mesh(*scene->surfaces, out_.mesh_spacing);
              }).wall_s;
    return mesh;
  }

  void add_peers() {
    EngineFigures figures;
    std::unique_ptr<RayEngine> engine;
    figures.name = "embree round cones";
    figures.primitives = workload_.size();
    figures.build_s = cost_of([&] { engine = embree_round_cones(workload_.flattened(), settings_.threads); }).wall_s;
    add_racer(figures, std::move(engine));
    if (!(out_.mesh_spacing > 0)) return;
    say("meshing");
    figures.name = "embree triangles";
    const TriangleMesh mesh = mesh_of_scene(figures.mesh_s);
    figures.primitives = mesh.triangles.size();
    figures.build_s =
        cost_of([&] { engine = embree_triangles(mesh, workload_.thinnest_radius() / 20, settings_.threads); }).wall_s;
    add_racer(figures, std::move(engine));
  }

  // What one more sample of each pixel costs: sixteen samples less one, so that what is done once cancels. Fifteen go
  // together, in the second pass of render(); the rays of a single sample go to the pixels' middles, as sixteen have to
  // beside their own.
  Cost further_sample(const PreparedScene& ready) const {
    RenderSettings render_settings = ready.description.render;
    const auto film = [&](int samples) {
      render_settings.samples_per_pixel = samples;
      return cost_of([&] { render(ready.render_scene, render_settings, {.crop = {}, .threads = settings_.threads}); });
    };
    const Cost one = film(1), many = film(16);
    return {(many.wall_s - one.wall_s) / 15, (many.cpu_s - one.cpu_s) / 15};
  }

  // Evaluations are counted beside the race, because counting takes time.
  template <class Frame>
  static void recorded(const PreparedScene& ready, RayCounts& counts, const Frame& frame) {
    const RayCounts again = frame(*recording_engine_of(*ready.surfaces));
    counts.evaluations = again.evaluations;
    counts.uncertified = again.uncertified;
  }

  void race_frames(const PreparedScene& ready) {
    further_sample(ready);  // samples beside the pixels' middles enter cells of their own
    std::vector<Cost> samples;
    for (int round = 0; round < settings_.rounds; ++round) {
      say(fmt::format("frames, round {} of {}", round + 1, settings_.rounds));
      for (Racer& r : racers_)
        r.frames.push_back(cost_of([&] { r.figures.frame = shaded_frame(*r.engine, workload_, frame_); }));
      samples.push_back(further_sample(ready));
    }
    for (Racer& r : racers_) {
      r.figures.frame_cost = median(r.frames);
      r.figures.frame_ratio = median_ratio(racers_.front().frames, r.frames);
    }
    out_.sample = median(samples);
    recorded(ready, racers_.front().figures.frame,
             [&](const RayEngine& engine) { return shaded_frame(engine, workload_, frame_); });
    if (racers_.size() > 1) out_.sample_over_cones = median_ratio(samples, racers_[1].frames);
  }

  void race_bounces(const PreparedScene& ready) {
    for (Racer& r : racers_) {
      r.starts = hits_of_frame(*r.engine, workload_, frame_);
      diffuse_paths(*r.engine, r.starts, bounces_of_a_path, frame_);  // bounces enter cells of their own
      r.engine->refine();
    }
    for (int round = 0; round < settings_.rounds; ++round) {
      say(fmt::format("bounces, round {} of {}", round + 1, settings_.rounds));
      for (Racer& r : racers_) {
        const Cost cost =
            cost_of([&] { r.figures.bounces = diffuse_paths(*r.engine, r.starts, bounces_of_a_path, frame_); });
        r.bounces.push_back(per_ray(cost, r.figures.bounces.rays));
      }
    }
    for (Racer& r : racers_) {
      r.figures.bounce_cost = median(r.bounces);
      r.figures.bounce_ratio = median_ratio(racers_.front().bounces, r.bounces);
    }
    Racer& own = racers_.front();
    recorded(ready, own.figures.bounces,
             [&](const RayEngine& engine) { return diffuse_paths(engine, own.starts, bounces_of_a_path, frame_); });
  }

  void describe_surfaces(const PreparedScene& ready) {
    const SurfaceReport built = report(*ready.surfaces);
    out_.cells = built.cells;
    out_.blocks = built.blocks;
    out_.bytes = built.bytes;
    out_.largest_error = built.largest_error;
  }

  // One further sample with the plain sum and with other rules, in turns.
  void compare_rules() {
    struct Rule {
      const char* name;
      const char* text;
    };
    // Strands that cross blend when they touch, parallel ones as the sum does
    constexpr Rule rules[] = {{"contact", "contact"}, {"directional", "{direction: [1.16, 1.57]}"}};
    const auto with = [&](const std::string& alpha) -> std::optional<PreparedScene> {
      say("alpha: " + alpha);
      const std::string blend = workload_.places.empty() ? "objects.shape.field.blend" : "defs.body.blend";
      auto ready = prepare_scene(scene_, {blend + ".alpha=" + alpha}, settings_.threads);
      if (ready) return std::move(*ready);
      out_.missing.push_back("alpha: " + alpha + ": " + ready.why().front().message);
      return std::nullopt;
    };
    const auto sum = with("sum");
    if (!sum) return;
    further_sample(*sum);
    for (const Rule& rule : rules) {
      const auto ready = with(rule.text);
      if (!ready) continue;
      further_sample(*ready);
      std::vector<Cost> ours, sums;
      for (int round = 0; round < settings_.rounds; ++round) {
        ours.push_back(further_sample(*ready));
        sums.push_back(further_sample(*sum));
      }
      out_.rules.push_back({rule.name, median_ratio(ours, sums)});
    }
  }

  const Workload& workload_;
  const BenchSettings& settings_;
  const FrameSettings frame_;
  const std::filesystem::path scene_;
  const std::function<void(const std::string&)>& tell_;
  std::vector<Racer> racers_;  // Marrow first, then the round cones
  WorkloadFigures out_;
};

}  // namespace

Result<std::vector<WorkloadFigures>> run_benchmark(const std::vector<Workload>& workloads,
                                                   const BenchSettings& settings,
                                                   const std::function<void(const std::string&)>& tell,
                                                   const std::function<void(const WorkloadFigures&)>& found) {
  const TemporaryFolder folder;
  if (folder.path().empty()) return failure("cannot make a folder for temporary files");
  std::vector<WorkloadFigures> all;
  const auto measure = [&](const Workload& workload, const BenchSettings& how) -> Status {
    auto figures = Measurement(workload, how, folder.path(), tell).run();
    if (!figures) return figures.why();
    found(*figures);
    all.push_back(std::move(*figures));
    return Done{};
  };
  for (const Workload& w : workloads)
    if (auto status = measure(w, settings); !status) return status.why();
  BenchSettings scaling = settings;
  scaling.mesh_spacing = 0;
  scaling.povray = scaling.rules = false;
  for (std::size_t count = 1000; count <= settings.largest_scaling; count *= 10)
    for (const Workload& w : {strands(count), tufts(count)})
      if (auto status = measure(w, scaling); !status) return status.why();
  return all;
}

}  // namespace marrow
