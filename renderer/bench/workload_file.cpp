// Workloads by name, their bounds, and their scene files.
#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "field/math/elementary.h"
#include "renderer/bench/workload.h"

namespace marrow {
namespace {

// From so many primitives on they stand in an SWC file, which is read faster and is shorter.
constexpr std::size_t many = 20'000;

struct Named {
  const char* name;
  Workload (*make)();
};
constexpr Named table[] = {{"w1", creature}, {"w2", hair}, {"w3", balls}};

// As many digits as tell the number from its neighbours: what is rendered is what was read.
std::string text(const Vec3d& p) { return fmt::format("[{}, {}, {}]", p.x, p.y, p.z); }
std::string direction_text(const Vec3d& p) { return fmt::format("[{:.10g}, {:.10g}, {:.10g}]", p.x, p.y, p.z); }

void write_head(std::ostream& out, const Workload& w, int film_size) {
  fmt::print(out,
             "# {}\nmarrow: 1\ncamera: {{from: {}, to: {}, fov: {:.10g}}}\nfilm: {{size: [{}, {}]}}\n"
             "render: {{integrator: direct, spp: 16}}\n"
             "lights:\n  - sun: {{direction: {}, angle: 0, irradiance: 3}}\n"
             "materials:\n  white: {{diffuse: {{color: 0.8}}}}\n",
             w.about, text(w.eye), text(w.looked_at()), w.fov_deg(), film_size, film_size,
             direction_text(w.toward_light));
}

// One blend as the field of the object; or, of a placed workload, by name, and the places that use it.
void write_blend_head(std::ostream& out, const Workload& w) {
  fmt::print(out, "{}      blend:\n        alpha: contact\n        of:\n",
             w.places.empty() ? "objects:\n  - name: shape\n    material: white\n    field:\n" : "defs:\n  body:\n");
}
void write_places(std::ostream& out, const Workload& w) {
  if (w.places.empty()) return;
  fmt::print(out, "objects:\n  - name: shape\n    material: white\n    field:\n      union:\n        of:\n");
  for (const Vec3d& p : w.places)
    fmt::print(out, "          - transform: {{translate: {}, of: {{use: body}}}}\n", text(p));
}

bool continues(const SegmentSkeleton& before, const SegmentSkeleton& s) {
  return before.to == s.from && before.radius_to == s.radius_from;
}

// Segments that follow each other are one polyline, one strand for rules that ask for directions.
void write_polyline(std::ostream& out, std::span<const SegmentSkeleton> chain) {
  std::string points = text(chain.front().from), radii = fmt::format("{}", chain.front().radius_from);
  for (const auto& s : chain) {
    points += ", " + text(s.to);
    radii += fmt::format(", {}", s.radius_to);
  }
  fmt::print(out, "          - polyline: {{points: [{}], radius: [{}]}}\n", points, radii);
}

void write_primitives(std::ostream& out, const Workload& w) {
  const std::span<const SegmentSkeleton> all = w.segments;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    for (end = begin + 1; end < all.size() && continues(all[end - 1], all[end]);) ++end;
    write_polyline(out, all.subspan(begin, end - begin));
  }
  for (const auto& p : w.points) fmt::print(out, "          - point: {{at: {}, radius: {}}}\n", text(p.at), p.radius);
}

// A segment that begins where the one before it ended continues its branch; a root without children is a point.
void write_swc(std::ostream& out, const Workload& w) {
  int id = 0;
  const SegmentSkeleton* before = nullptr;
  for (const auto& s : w.segments) {
    if (before == nullptr || !continues(*before, s))
      fmt::print(out, "{} 0 {} {} {} {} -1\n", ++id, s.from.x, s.from.y, s.from.z, s.radius_from);
    fmt::print(out, "{} 0 {} {} {} {} {}\n", id + 1, s.to.x, s.to.y, s.to.z, s.radius_to, id);
    ++id;
    before = &s;
  }
  for (const auto& p : w.points) fmt::print(out, "{} 0 {} {} {} {} -1\n", ++id, p.at.x, p.at.y, p.at.z, p.radius);
}

Box3 placed(const Box3& box, const std::vector<Vec3d>& places) {
  if (places.empty()) return box;
  Box3 all;
  for (const Vec3d& p : places) all.include(Box3{box.lower + p, box.upper + p});
  return all;
}

Status write_text(const std::string& text, const std::filesystem::path& path) {
  std::ofstream out(path);
  out << text;
  out.close();
  if (out) return Done{};
  return failure("cannot write " + path.string() + ": " + std::generic_category().message(errno));
}

}  // namespace

Box3 Workload::bounds() const {
  Box3 box;
  const auto include = [&](const Vec3d& p, double r) {
    box.include(p - Vec3d{r, r, r});
    box.include(p + Vec3d{r, r, r});
  };
  for (const auto& s : segments) {
    include(s.from, s.radius_from);
    include(s.to, s.radius_to);
  }
  for (const auto& p : points) include(p.at, p.radius);
  return placed(box, places);
}

Box3 Workload::extent() const {
  Box3 box;
  double largest_radius = 0;
  const auto include = [&](const Vec3d& p, double r) {
    box.include(p);
    largest_radius = std::max(largest_radius, r);
  };
  for (const auto& s : segments) {
    include(s.from, s.radius_from);
    include(s.to, s.radius_to);
  }
  for (const auto& p : points) include(p.at, p.radius);
  return placed(box.padded(largest_radius), places);
}

Vec3d Workload::looked_at() const { return {eye.x, eye.y, eye.z >= 1 ? 0 : eye.z - 1}; }

double Workload::fov_deg() const { return 2 * atan(tan_half_fov) * 57.29577951308232; }

double Workload::thinnest_radius() const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& s : segments) least = std::min({least, s.radius_from, s.radius_to});
  for (const auto& p : points) least = std::min(least, p.radius);
  return least;
}

Workload Workload::flattened() const {
  if (places.empty()) return *this;
  Workload flat = *this;
  flat.places.clear();
  flat.segments.clear();
  flat.points.clear();
  for (const Vec3d& place : places) {
    for (const auto& s : segments) flat.segments.push_back({s.from + place, s.to + place, s.radius_from, s.radius_to});
    for (const auto& p : points) flat.points.push_back({p.at + place, p.radius});
  }
  return flat;
}

std::vector<std::string> workload_names() {
  std::vector<std::string> names;
  for (const Named& n : table) names.emplace_back(n.name);
  return names;
}

Result<Workload> workload_named(std::string_view name) {
  for (const Named& n : table)
    if (name == n.name) return n.make();
  return with_hint(failure("there is no workload `" + std::string(name) + "`"),
                   fmt::format("there are {}, and files of skeletons", fmt::join(workload_names(), ", ")));
}

SceneText scene_text(const Workload& w, int film_size, const std::string& skeleton_name) {
  std::ostringstream scene, skeleton;
  write_head(scene, w, film_size);
  write_blend_head(scene, w);
  if (w.segments.size() + w.points.size() < many) {
    write_primitives(scene, w);
  } else {
    fmt::print(scene, "          - skeleton: {{file: {}}}\n", skeleton_name);
    write_swc(skeleton, w);
  }
  write_places(scene, w);
  return {std::move(scene).str(), std::move(skeleton).str()};
}

Status write_scene(const Workload& w, int film_size, const std::filesystem::path& scene) {
  auto skeleton = scene;
  skeleton.replace_extension(".swc");
  const SceneText text = scene_text(w, film_size, skeleton.filename().string());
  if (!text.skeleton.empty())
    if (auto status = write_text(text.skeleton, skeleton); !status) return status;
  return write_text(text.scene, scene);
}

}  // namespace marrow
