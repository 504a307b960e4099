// The workloads run, with Marrow and what there is of its peers in turns.
#include "renderer/bench/benchmark.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "renderer/bench/dual_mesh.h"
#include "renderer/bench/frames.h"
#include "renderer/bench/further_sample.h"
#include "renderer/bench/prepared_scene.h"
#include "renderer/bench/process_race.h"
#include "renderer/bench/temporary_folder.h"
#include "renderer/bench/workload.h"
#include "renderer/geometry/build_surfaces.h"

namespace marrow {
namespace {

constexpr int bounces_of_a_path = 4;
constexpr const char* cones = "embree round cones";

// An engine at work: what is timed goes into the lists, one entry a round.
struct Racer {
  EngineFigures figures;
  std::unique_ptr<RayEngine> engine;
  std::vector<Cost> frames, bounces;
  std::vector<EngineHit> starts;
};

std::optional<Cost> per_ray(const Cost& cost, std::uint64_t rays) {
  if (rays == 0) return std::nullopt;
  const auto n = static_cast<double>(rays);
  return Cost{cost.wall_s / n, cost.cpu_s / n};
}

// Ours over theirs, of a bounce; nothing where one of them had no hit to bounce from.
Ratio bounce_ratio(const Racer& ours, const Racer& theirs) {
  const auto our_rays = static_cast<double>(ours.figures.bounces.rays);
  const auto their_rays = static_cast<double>(theirs.figures.bounces.rays);
  if (!(our_rays > 0 && their_rays > 0)) return {};
  return median_ratio(whole_costs(ours.bounces), whole_costs(theirs.bounces)) * (their_rays / our_rays);
}

class Measurement {
 public:
  Measurement(const Workload& workload, const BenchSettings& settings, const std::filesystem::path& folder,
              const std::function<void(const std::string&)>& tell)
      : workload_(workload),
        settings_(settings),
        frame_{settings.size, settings.threads, settings.stop},
        scene_(folder / (workload.name + ".yaml")),
        tell_(tell) {
    const double usual = max_component(workload.bounds().size()) / 500;
    out_.mesh_spacing = settings.mesh_spacing.value_or(std::max(usual, finest_mesh_spacing(workload.extent())));
  }

  /// Nothing when it was asked to stop.
  Result<std::optional<WorkloadFigures>> run() {
    out_.name = workload_.name;
    out_.about = workload_.about;
    out_.primitives = workload_.size();
    say("reading and building");
    if (auto status = write_scene(workload_, settings_.size, scene_); !status) return status.why();
    auto ready = prepare_scene(scene_, {}, settings_.threads);
    if (!ready) return no_scene(ready.why().front());
    measure(*ready);
    if (settings_.stop.is_made()) return std::optional<WorkloadFigures>{};
    for (Racer& r : racers_) out_.engines.push_back(std::move(r.figures));
    return std::optional(std::move(out_));
  }

 private:
  // Where in the temporary scene it stands tells nobody anything.
  Diagnostic no_scene(Diagnostic why) const {
    why.where = {.file = workload_.name};
    why.message = "no scene can be made of it: " + why.message;
    return why;
  }
  void say(const std::string& what) const { tell_(workload_.name + ": " + what); }
  bool is_stopped() const { return settings_.stop.is_made(); }

  void measure(const PreparedScene& ready) {
    if (is_stopped()) return;
    add_marrow(ready);
    describe_surfaces(ready);
    if (!is_stopped()) add_peers();
    if (!is_stopped()) race_frames(ready);
    if (!is_stopped()) race_bounces(ready);
    if (settings_.rules && !is_stopped()) compare_rules();
    if (settings_.processes && !is_stopped()) race_processes(workload_, settings_, scene_, tell_, out_);
  }

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
  Result<TriangleMesh> mesh_of_scene(double& seconds) const {
    Result<TriangleMesh> mesh = TriangleMesh{};
    seconds = cost_of([&] {
                if (const auto scene = prepare_scene(scene_, {}, settings_.threads))
                  mesh = dual_mesh(*scene->surfaces, out_.mesh_spacing, settings_.stop);
              }).wall_s;
    return mesh;
  }

  void add_peers() {
    EngineFigures figures;
    std::unique_ptr<RayEngine> engine;
    figures.name = cones;
    figures.primitives = workload_.size();
    figures.build_s = cost_of([&] { engine = embree_round_cones(workload_.flattened(), settings_.threads); }).wall_s;
    add_racer(figures, std::move(engine));
    if (!(out_.mesh_spacing > 0) || is_stopped()) return;
    say("meshing");
    figures.name = "embree triangles";
    const auto mesh = mesh_of_scene(figures.mesh_s);
    if (is_stopped()) return;
    if (!mesh) return out_.missing.push_back(figures.name + ": " + mesh.why().front().message);
    figures.primitives = mesh->triangles.size();
    figures.build_s =
        cost_of([&] { engine = embree_triangles(*mesh, workload_.thinnest_radius() / 20, settings_.threads); }).wall_s;
    add_racer(figures, std::move(engine));
  }

  TwoRuns further_sample(const PreparedScene& ready) const {
    return sixteen_samples_and_one(ready, settings_.threads, settings_.stop);
  }

  // Evaluations are counted beside the race, because counting takes time.
  template <class Frame>
  static RayProof recorded(const PreparedScene& ready, const Frame& frame) {
    const RayCounts counts = frame(*recording_engine_of(*ready.surfaces));
    return {counts.evaluations, counts.uncertified};
  }

  void race_frames(const PreparedScene& ready) {
    further_sample(ready);  // samples beside the pixels' middles enter cells of their own
    std::vector<TwoRuns> samples;
    for (int round = 0; round < settings_.rounds && !is_stopped(); ++round) {
      say(fmt::format("frames, round {} of {}", round + 1, settings_.rounds));
      for (Racer& r : racers_)
        r.frames.push_back(cost_of([&] { r.figures.frame = shaded_frame(*r.engine, workload_, frame_); }));
      samples.push_back(further_sample(ready));
    }
    const Costs sample = further_sample_costs(samples), own = whole_costs(racers_.front().frames);
    out_.sample = median(sample);
    for (Racer& r : racers_) {
      const Costs frames = whole_costs(r.frames);
      r.figures.frame_cost = median(r.frames);
      r.figures.frame_ratio = median_ratio(own, frames);
      if (r.figures.name == cones) out_.sample_over_cones = median_ratio(sample, frames);
    }
    racers_.front().figures.frame_proof =
        recorded(ready, [&](const RayEngine& engine) { return shaded_frame(engine, workload_, frame_); });
  }

  void race_bounces(const PreparedScene& ready) {
    for (Racer& r : racers_) {
      r.starts = hits_of_frame(*r.engine, workload_, frame_);
      diffuse_paths(*r.engine, r.starts, bounces_of_a_path, frame_);  // bounces enter cells of their own
      r.engine->refine();
    }
    for (int round = 0; round < settings_.rounds && !is_stopped(); ++round) {
      say(fmt::format("bounces, round {} of {}", round + 1, settings_.rounds));
      for (Racer& r : racers_)
        r.bounces.push_back(
            cost_of([&] { r.figures.bounces = diffuse_paths(*r.engine, r.starts, bounces_of_a_path, frame_); }));
    }
    Racer& own = racers_.front();
    for (Racer& r : racers_) {
      r.figures.bounce_cost = per_ray(median(r.bounces), r.figures.bounces.rays);
      r.figures.bounce_ratio = bounce_ratio(own, r);
    }
    own.figures.bounce_proof = recorded(
        ready, [&](const RayEngine& engine) { return diffuse_paths(engine, own.starts, bounces_of_a_path, frame_); });
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
      if (is_stopped()) return;
      const auto ready = with(rule.text);
      if (!ready) continue;
      further_sample(*ready);
      std::vector<TwoRuns> ours, sums;
      for (int round = 0; round < settings_.rounds && !is_stopped(); ++round) {
        ours.push_back(further_sample(*ready));
        sums.push_back(further_sample(*sum));
      }
      out_.rules.push_back({rule.name, median_ratio(further_sample_costs(ours), further_sample_costs(sums))});
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
  if (folder.path().empty())
    return with_hint(failure("cannot make a folder for temporary files: " + folder.why_not()),
                     "TMPDIR names the folder in which it is made");
  std::vector<WorkloadFigures> all;
  const auto measure = [&](const Workload& workload, const BenchSettings& how) -> Status {
    auto figures = Measurement(workload, how, folder.path(), tell).run();
    if (!figures) return figures.why();
    if (!*figures) return Done{};
    found(**figures);
    all.push_back(std::move(**figures));
    return Done{};
  };
  for (const Workload& w : workloads) {
    if (settings.stop.is_made()) return all;
    if (auto status = measure(w, settings); !status) return status.why();
  }
  BenchSettings scaling = settings;
  scaling.mesh_spacing = 0;
  scaling.povray = scaling.rules = false;
  for (std::size_t count = 1000; count <= settings.largest_scaling; count *= 10)
    for (const Workload& w : {strands(count), tufts(count)}) {
      if (settings.stop.is_made()) return all;
      if (auto status = measure(w, scaling); !status) return status.why();
    }
  return all;
}

}  // namespace marrow
