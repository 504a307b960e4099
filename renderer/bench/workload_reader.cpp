// The peers' text is read here, skeletons by the readers of scenes.
#include "renderer/bench/workload_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/core.h>

#include "field/math/elementary.h"
#include "renderer/scene/files/skeleton_file.h"
#include "renderer/scene/files/text_scan.h"

namespace marrow {
namespace {

std::string ending_of(const std::string& name) { return std::filesystem::path(name).extension().string(); }

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

// Looks along -z at all of it, from as far as the workloads that have names: some two sides of the picture away.
void look_at(Workload& w) {
  constexpr double around = 1.05;
  w.tan_half_fov = 0.2;
  const Box3 box = w.bounds();
  const double half = std::max(box.size().x, box.size().y) / 2;
  w.eye = box.center() + Vec3d{0, 0, box.size().z / 2 + std::max(half, box.size().z / 2) * around / w.tan_half_fov};
}

class WorkloadText {
 public:
  WorkloadText(std::string_view text, const std::string& name) : text_(text), problems_(text, name) {}

  Result<Workload> read() {
    Lines lines(text_);
    for (std::string_view line; !problems_.is_full() && lines.next(line);) read_line(line.substr(0, line.find('#')));
    if (problems_.none() && made_.size() == 0)
      problems_.complain_of_file("there is nothing to draw", "a line is `seg` or `pt` and numbers");
    if (!problems_.none()) return problems_.take();
    if (!has_camera_) look_at(made_);
    if (!has_light_) made_.toward_light = creature().toward_light;
    return std::move(made_);
  }

 private:
  struct Statement {
    std::string_view keyword;
    std::size_t least, most;  // numbers
    const char* form;
    void (WorkloadText::*take)(const double* numbers, const char* place);
  };
  static constexpr std::size_t most_numbers = 9;
  static const std::array<Statement, 4> statements;

  void read_line(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword.empty()) return;
    const auto* s = std::ranges::find(statements, keyword, &Statement::keyword);
    if (s == statements.end())
      return problems_.complain(keyword.data(), quoted_word(keyword) + " is not a statement",
                                "a line begins with cam, light, seg or pt");
    std::array<double, most_numbers> numbers{};
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
      if (count == s->most) return problems_.complain(word.data(), "there are too many numbers", s->form);
      const auto number = finite_number(word);
      if (!number) return problems_.complain(word.data(), quoted_word(word) + " is not a finite number", s->form);
      numbers[count] = *number;
    }
    if (count < s->least) return problems_.complain(keyword.data(), fmt::format("found {} numbers", count), s->form);
    (this->*s->take)(numbers.data(), keyword.data());
  }

  static Vec3d vec(const double* n) { return {n[0], n[1], n[2]}; }

  void take_once(bool& has, const char* place) {
    if (std::exchange(has, true)) problems_.complain(place, "there is a second one", "one is taken");
  }
  void take_camera(const double* n, const char* place) {
    take_once(has_camera_, place);
    if (!(n[3] > 0)) problems_.complain(place, "the tangent of half the angle of view is not above 0");
    made_.eye = vec(n);
    made_.tan_half_fov = n[3];
  }
  void take_light(const double* n, const char* place) {
    take_once(has_light_, place);
    if (length(vec(n)) == 0) return problems_.complain(place, "a direction has a length");
    made_.toward_light = normalize(vec(n));
  }
  void check_radius(double radius, const char* place) {
    if (!(radius > 0)) problems_.complain(place, "a radius is not above 0");
  }
  void take_segment(const double* n, const char* place) {
    for (const double radius : {n[3], n[7]}) check_radius(radius, place);
    if (vec(n) == vec(n + 4)) return problems_.complain(place, "a segment has no length");
    made_.segments.push_back({vec(n), vec(n + 4), n[3], n[7]});
  }
  void take_point(const double* n, const char* place) {
    check_radius(n[3], place);
    made_.points.push_back({vec(n), n[3]});
  }

  std::string_view text_;
  FileProblems problems_;
  Workload made_;
  bool has_camera_ = false, has_light_ = false;
};

const std::array<WorkloadText::Statement, 4> WorkloadText::statements{{
    {"cam", 4, 4, "cam x y z t, with t the tangent of half the angle of view", &WorkloadText::take_camera},
    {"light", 3, 3, "light x y z, towards the sun", &WorkloadText::take_light},
    {"seg", 8, 9, "seg x y z r x y z r, then perhaps a strength", &WorkloadText::take_segment},
    {"pt", 4, 5, "pt x y z r, then perhaps a strength", &WorkloadText::take_point},
}};

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
  look_at(w);
  return w;
}

Result<Workload> workload_in(std::string_view bytes, const std::string& name) {
  const auto format = skeleton_format_of(name);
  if (!format) return WorkloadText(bytes, name).read();
  const auto skeleton = read_skeleton(*format, bytes, {}, name);
  if (!skeleton) return skeleton.why();
  return workload_of(skeleton->graph);
}

}  // namespace

bool is_workload_file(const std::string& name) { return ending_of(name) == ".txt" || skeleton_format_of(name); }

Result<Workload> read_workload(std::string_view bytes, const std::string& name) {
  auto w = workload_in(bytes, name);
  if (!w) return w.why();
  w->name = stem_of(name);
  w->about = fmt::format("{} segments and {} points of {}", w->segments.size(), w->points.size(),
                         std::filesystem::path(name).filename().string());
  return w;
}

}  // namespace marrow
