// The peers' text is read by workload_text.h, skeletons by the readers of scenes.
#include "renderer/bench/workload_reader.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include <fmt/core.h>

#include "renderer/bench/workload_text.h"
#include "renderer/scene/files/ascii.h"
#include "renderer/scene/files/skeleton_file.h"

namespace marrow {
namespace {

// What can stand in a scene file and in the name of a file everywhere.
std::string stem_of(const std::string& name) {
  std::string stem = std::filesystem::path(name).stem().string();
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  for (char& c : stem)
    if (!is_plain(c)) c = '_';
  return stem;
}

Workload workload_of(const SkeletonGraph& graph) {
  Workload w;
  std::vector<bool> has_children(graph.positions.size());
  const auto parent_of = [&](std::size_t i) {
    return graph.parents.empty() ? SkeletonGraph::no_parent : graph.parents[i];
  };
  for (std::size_t i = 0; i < graph.positions.size(); ++i) {
    if (parent_of(i) == SkeletonGraph::no_parent) continue;
    const auto parent = static_cast<std::size_t>(parent_of(i));
    has_children[parent] = true;
    if (graph.positions[parent] == graph.positions[i]) continue;
    w.segments.push_back({graph.positions[parent], graph.positions[i], graph.radii[parent], graph.radii[i]});
  }
  for (std::size_t i = 0; i < graph.positions.size(); ++i)
    if (parent_of(i) == SkeletonGraph::no_parent && !has_children[i])
      w.points.push_back({graph.positions[i], graph.radii[i]});
  w.toward_light = creature().toward_light;
  return w;
}

// The readers speak to authors of scenes, and bench has no place for what they advise.
Diagnostics without_a_scene(Diagnostics found) {
  constexpr std::array<std::string_view, 4> keys{"`radius`", "`min_radius`", "columns:", "`mesh:`"};
  for (Diagnostic& d : found)
    if (std::ranges::any_of(keys, [&](std::string_view key) { return d.hint.find(key) != std::string::npos; }))
      d.hint += "; such a key stands in a scene, and bench takes none";
  return found;
}

Result<WorkloadFile> skeleton_in(SkeletonFormat format, std::string_view bytes, const std::string& name) {
  const auto skeleton = read_skeleton(format, bytes, {}, name);
  if (!skeleton) return without_a_scene(skeleton.why());
  WorkloadFile made{workload_of(skeleton->graph), without_a_scene(skeleton->warnings)};
  if (made.workload.size() == 0) return failure("there is nothing to draw: all nodes are at one place", name);
  look_at_all(made.workload);
  if (eye_is_too_far(made.workload))
    return failure("it is so large that an eye that sees all of it stands beyond 1e15 scene units", name);
  return made;
}

Result<WorkloadFile> text_in(std::string_view bytes, const std::string& name) {
  auto workload = read_workload_text(bytes, name);
  if (!workload) return workload.why();
  return WorkloadFile{std::move(*workload), {}};
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return count == 0 ? "" : fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string contents_of(const Workload& w) {
  const std::string segments = counted(w.segments.size(), "segment", "segments");
  const std::string points = counted(w.points.size(), "point", "points");
  return segments + (segments.empty() || points.empty() ? "" : " and ") + points;
}

}  // namespace

bool is_workload_file(const std::string& name) { return ending_of(name) == ".txt" || skeleton_format_of(name); }

Result<WorkloadFile> read_workload(std::string_view bytes, const std::string& name) {
  const auto format = skeleton_format_of(name);
  auto made = format ? skeleton_in(*format, bytes, name) : text_in(bytes, name);
  if (!made) return made.why();
  Workload& w = made->workload;
  w.name = stem_of(name);
  w.about = contents_of(w) + " of " + std::filesystem::path(name).filename().string();
  return made;
}

}  // namespace marrow
