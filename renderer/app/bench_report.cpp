// What a benchmark found, for people and for programs.
#include "renderer/app/bench_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace marrow {
namespace {

using Json = nlohmann::ordered_json;

double per(double amount, std::uint64_t count) { return count == 0 ? 0 : amount / static_cast<double>(count); }
double per_second(std::uint64_t count, double seconds) {
  return seconds > 0 ? static_cast<double>(count) / seconds : 0;
}

Json json(const Cost& c) { return {{"wall_seconds", c.wall_s}, {"cpu_seconds", c.cpu_s}}; }
Json json(const Ratio& r) { return {{"wall", r.wall}, {"cpu", r.cpu}}; }

Json json(const EngineFigures& e) {
  return {{"name", e.name},
          {"primitives", e.primitives},
          {"meshing_wall_seconds", e.mesh_s},
          {"build_wall_seconds", e.build_s},
          {"frame", json(e.frame_cost)},
          {"frame_rays", e.frame.rays},
          {"frame_hits", e.frame.hits},
          {"frame_shadow_rays", e.frame.shadow_rays},
          {"rays_per_second", per_second(e.frame.rays + e.frame.shadow_rays, e.frame_cost.wall_s)},
          {"evaluations_per_ray", per(static_cast<double>(e.frame.evaluations), e.frame.rays)},
          {"uncertified_rays", e.frame.uncertified},
          {"bounce_rays", e.bounces.rays},
          {"bounce_ray", json(e.bounce_cost)},
          {"bounce_rays_per_second", e.bounce_cost.wall_s > 0 ? 1 / e.bounce_cost.wall_s : 0},
          {"bounce_evaluations_per_ray", per(static_cast<double>(e.bounces.evaluations), e.bounces.rays)},
          {"marrow_frame_over_this", json(e.frame_ratio)},
          {"marrow_bounce_over_this", json(e.bounce_ratio)}};
}

Json json(const ProcessFigures& p) {
  return {{"name", p.name},
          {"samples_per_pixel", p.samples},
          {"whole_process", json(p.cost)},
          {"peak_memory_bytes", p.peak_bytes},
          {"this_over_marrow", json(p.ratio)}};
}

Json json(const WorkloadFigures& w) {
  Json out{{"name", w.name},
           {"about", w.about},
           {"primitives", w.primitives},
           {"mesh_spacing_scene_units", w.mesh_spacing},
           {"cells", w.cells},
           {"cells_with_rays", w.blocks},
           {"memory_bytes", w.bytes},
           {"largest_certified_error", w.largest_error},
           {"read_wall_seconds", w.read_s},
           {"build_wall_seconds", w.build_s},
           {"file_to_first_ray_wall_seconds", w.first_ray_s},
           {"first_frame", json(w.first_frame)},
           {"further_sample", json(w.sample)},
           {"further_sample_over_round_cones", json(w.sample_over_cones)},
           {"rules", Json::array()}};
  for (const auto& rule : w.rules)
    out["rules"].push_back({{"alpha", rule.alpha}, {"over_plain_sum", json(rule.over_sum)}});
  out["engines"] = Json::array();
  for (const auto& e : w.engines) out["engines"].push_back(json(e));
  out["processes"] = Json::array();
  for (const auto& p : w.processes) out["processes"].push_back(json(p));
  out["missing"] = w.missing;
  return out;
}

std::string text(const EngineFigures& e) {
  return fmt::format("  {:<20}{:>10}{:>9.2f} s{:>9.3f} s{:>9.3f} s{:>9.2f}{:>9.2f}x{:>9.0f} ns{:>8.2f}x\n", e.name,
                     e.primitives, e.build_s, e.frame_cost.wall_s, e.frame_cost.cpu_s,
                     1e-6 * per_second(e.frame.rays + e.frame.shadow_rays, e.frame_cost.wall_s), e.frame_ratio.cpu,
                     1e9 * e.bounce_cost.cpu_s, e.bounce_ratio.cpu);
}

std::string text(const ProcessFigures& p) {
  return fmt::format("  {:<20}{:>4} spp {:>9.2f} s wall{:>9.2f} s cpu{:>9.0f} MiB  {:.1f} times Marrow's (wall)\n",
                     p.name, p.samples, p.cost.wall_s, p.cost.cpu_s, static_cast<double>(p.peak_bytes) / (1 << 20),
                     p.ratio.wall);
}

}  // namespace

std::string bench_text(const WorkloadFigures& w) {
  std::string out = fmt::format("{}: {}\n", w.name, w.about);
  const auto line = [&](const char* name, const std::string& value) {
    out += fmt::format("  {:<26}{}\n", name, value);
  };
  const auto both = [](const Cost& c) { return fmt::format("{:.3f} s wall, {:.3f} s cpu", c.wall_s, c.cpu_s); };
  line("file read, surfaces built", fmt::format("{:.3f} s, {:.3f} s", w.read_s, w.build_s));
  line("file to first ray", fmt::format("{:.3f} s", w.first_ray_s));
  line("first frame", both(w.first_frame));
  line("cells, with rays", fmt::format("{}, {}", w.cells, w.blocks));
  line("memory of the surfaces", fmt::format("{:.1f} MiB", static_cast<double>(w.bytes) / (1 << 20)));
  line("one further sample", both(w.sample) + fmt::format("; {:.2f} times round cones (cpu {:.2f})",
                                                          w.sample_over_cones.wall, w.sample_over_cones.cpu));
  for (const auto& rule : w.rules)
    line(("alpha: " + rule.alpha).c_str(), fmt::format("{:.3f} times the plain sum (cpu)", rule.over_sum.cpu));
  const RayCounts& frame = w.engines.front().frame;
  line("evaluations per ray",
       fmt::format("{:.2f}, {:.2f} of bounces", per(double(frame.evaluations), frame.rays),
                   per(double(w.engines.front().bounces.evaluations), w.engines.front().bounces.rays)));
  line("rays not certified", fmt::format("{} of {}", frame.uncertified, frame.rays));
  out += fmt::format("  {:<20}{:>10}{:>11}{:>11}{:>11}{:>9}{:>10}{:>12}{:>9}\n", "engine", "primitives", "build",
                     "frame", "cpu", "Mray/s", "marrow/", "bounce ray", "marrow/");
  for (const auto& e : w.engines) {
    out += text(e);
    if (e.mesh_s > 0) out += fmt::format("  {:<20}{:>20.2f} s to make the mesh, by Marrow's rays\n", "", e.mesh_s);
  }
  for (const auto& p : w.processes) out += text(p);
  for (const auto& m : w.missing) out += "  not compared: " + m + '\n';
  return out + '\n';
}

std::string bench_text(const BenchSettings& settings) {
  return fmt::format(
      "{0} x {0} pixels, {1} threads, medians of {2}; a frame is a ray a pixel and a shadow ray a lit hit\n\n",
      settings.size, settings.threads, settings.rounds);
}

std::string bench_json(const BenchSettings& settings, const std::vector<WorkloadFigures>& all) {
  Json out{{"size_pixels", settings.size}, {"threads", settings.threads}, {"rounds", settings.rounds}};
  out["workloads"] = Json::array();
  for (const auto& w : all) out["workloads"].push_back(json(w));
  return out.dump(2) + '\n';
}

}  // namespace marrow
