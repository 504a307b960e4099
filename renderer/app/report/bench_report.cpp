// What a benchmark found, for people and for programs.
#include "renderer/app/report/bench_report.h"

#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace marrow {
namespace {

using Json = nlohmann::ordered_json;

double per_second(std::uint64_t count, double seconds) {
  return seconds > 0 ? static_cast<double>(count) / seconds : 0;
}

// null: there is no answer, or the times are too short to tell.
template <class T>
Json json(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
Json json(const Cost& c) { return {{"wall_seconds", c.wall_s}, {"cpu_seconds", c.cpu_s}}; }
Json json(const MaybeCost& c) { return {{"wall_seconds", json(c.wall_s)}, {"cpu_seconds", json(c.cpu_s)}}; }
Json json(const Ratio& r) { return {{"wall", json(r.wall)}, {"cpu", json(r.cpu)}}; }

std::optional<double> evaluations_per_ray(const std::optional<RayProof>& proof, const RayCounts& counts) {
  if (!proof || counts.rays == 0) return std::nullopt;
  return static_cast<double>(proof->evaluations) / static_cast<double>(counts.rays);
}
std::optional<std::uint64_t> uncertified(const EngineFigures& e) {
  if (!e.frame_proof) return std::nullopt;
  return e.frame_proof->uncertified;
}

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
          {"evaluations_per_ray", json(evaluations_per_ray(e.frame_proof, e.frame))},
          {"uncertified_rays", json(uncertified(e))},
          {"bounce_rays", e.bounces.rays},
          {"bounce_ray", e.bounce_cost ? json(*e.bounce_cost) : Json(nullptr)},
          {"bounce_rays_per_second", e.bounce_cost ? Json(per_second(1, e.bounce_cost->wall_s)) : Json(nullptr)},
          {"bounce_evaluations_per_ray", json(evaluations_per_ray(e.bounce_proof, e.bounces))},
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

constexpr const char* too_short = "too short to tell";

std::string seconds(const std::optional<double>& s, const char* of) {
  return s ? fmt::format("{:.3f} s {}", *s, of) : fmt::format("{} {}", of, too_short);
}
std::string text(const Cost& c) { return fmt::format("{:.3f} s wall, {:.3f} s cpu", c.wall_s, c.cpu_s); }
std::string text(const MaybeCost& c) {
  if (!c.wall_s && !c.cpu_s) return too_short;
  return seconds(c.wall_s, "wall") + ", " + seconds(c.cpu_s, "cpu");
}
std::string times(const std::optional<double>& ratio, int decimals) {
  return ratio ? fmt::format("{:.{}f}", *ratio, decimals) : too_short;
}

// In a column of the table of engines.
std::string column(const std::optional<double>& ratio) { return ratio ? fmt::format("{:.2f}x", *ratio) : "too short"; }

std::string bounce_columns(const EngineFigures& e, const EngineFigures& own) {
  const bool is_compared = e.bounce_cost && own.bounce_cost;
  return fmt::format("{:>13}{:>11}\n", e.bounce_cost ? fmt::format("{:.0f} ns", 1e9 * e.bounce_cost->cpu_s) : "no hits",
                     is_compared ? column(e.bounce_ratio.cpu) : "-");
}

std::string text(const EngineFigures& e, const EngineFigures& own) {
  return fmt::format("  {:<20}{:>10}{:>9.2f} s{:>9.3f} s{:>9.3f} s{:>9.2f}{:>11}", e.name, e.primitives, e.build_s,
                     e.frame_cost.wall_s, e.frame_cost.cpu_s,
                     1e-6 * per_second(e.frame.rays + e.frame.shadow_rays, e.frame_cost.wall_s),
                     column(e.frame_ratio.cpu)) +
         bounce_columns(e, own);
}

std::string table_of_engines(const WorkloadFigures& w) {
  std::string out = fmt::format("  {:<20}{:>10}{:>11}{:>11}{:>11}{:>9}{:>11}{:>13}{:>11}\n", "engine", "primitives",
                                "build", "frame", "cpu", "Mray/s", "marrow/", "bounce ray", "marrow/");
  for (const auto& e : w.engines) {
    out += text(e, w.engines.front());
    if (e.mesh_s > 0) out += fmt::format("  {:<20}{:>20.2f} s to make the mesh, by Marrow's rays\n", "", e.mesh_s);
  }
  return out;
}

// Of Marrow itself there is no ratio to tell.
std::string text(const ProcessFigures& p) {
  const std::string line = fmt::format("  {:<20}{:>4} spp {:>9.2f} s wall{:>9.2f} s cpu{:>9.0f} MiB", p.name, p.samples,
                                       p.cost.wall_s, p.cost.cpu_s, static_cast<double>(p.peak_bytes) / (1 << 20));
  if (p.name == "marrow") return line + '\n';
  if (!p.ratio.wall && !p.ratio.cpu) return line + "  not compared with Marrow's\n";
  return line + fmt::format("  {} times Marrow's (wall), {} (cpu)\n", times(p.ratio.wall, 1), times(p.ratio.cpu, 1));
}

std::string evaluations_text(const EngineFigures& own) {
  const auto frame = evaluations_per_ray(own.frame_proof, own.frame);
  const auto bounces = evaluations_per_ray(own.bounce_proof, own.bounces);
  return fmt::format("{:.2f}, ", frame.value_or(0)) +
         (bounces ? fmt::format("{:.2f} of bounces", *bounces) : "no hits to bounce from");
}

std::string further_sample_text(const WorkloadFigures& w) {
  const Ratio& r = w.sample_over_cones;
  if (!w.sample.wall_s && !w.sample.cpu_s) return too_short;
  if (!r.wall && !r.cpu) return text(w.sample) + "; times round cones: " + too_short;
  return text(w.sample) + fmt::format("; {} times round cones (cpu {})", times(r.wall, 2), times(r.cpu, 2));
}

}  // namespace

std::string bench_text(const WorkloadFigures& w) {
  std::string out = fmt::format("{}: {}\n", w.name, w.about);
  const auto line = [&](const char* name, const std::string& value) {
    out += fmt::format("  {:<26}{}\n", name, value);
  };
  line("file read, surfaces built", fmt::format("{:.3f} s, {:.3f} s", w.read_s, w.build_s));
  line("file to first ray", fmt::format("{:.3f} s", w.first_ray_s));
  line("first frame", text(w.first_frame));
  line("cells, with rays", fmt::format("{}, {}", w.cells, w.blocks));
  line("memory of the surfaces", fmt::format("{:.1f} MiB", static_cast<double>(w.bytes) / (1 << 20)));
  line("one further sample", further_sample_text(w));
  for (const auto& rule : w.rules)
    line(("alpha: " + rule.alpha).c_str(),
         rule.over_sum.cpu ? fmt::format("{:.3f} times the plain sum (cpu)", *rule.over_sum.cpu) : too_short);
  const EngineFigures& own = w.engines.front();
  line("evaluations per ray", evaluations_text(own));
  line("rays not certified", fmt::format("{} of {}", uncertified(own).value_or(0), own.frame.rays));
  out += table_of_engines(w);
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
  if (settings.stop.is_made()) out["interrupted"] = true;
  out["workloads"] = Json::array();
  for (const auto& w : all) out["workloads"].push_back(json(w));
  return out.dump(2) + '\n';
}

}  // namespace marrow
